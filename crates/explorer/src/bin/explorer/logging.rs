//! Logs go to stderr; EXPLORER_LOG chooses them (for example `EXPLORER_LOG=debug`), warnings by default.

use tracing_subscriber::EnvFilter;

/// Begins logging.
pub(crate) fn begin() {
    let filter = EnvFilter::try_from_env("EXPLORER_LOG").unwrap_or_else(|_| EnvFilter::new("warn"));
    let logs = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr);
    // Fails only if logging has begun already.
    let _ = logs.try_init();
}
