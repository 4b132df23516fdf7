//! Network name and password, checked for what the space-separated wire text can carry.

use alloc::string::String;
use core::fmt;

/// Why a network name or password is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CredentialsError {
    /// The length is not one that Wi-Fi has.
    #[error("{what} has {length} bytes: give {min} to {max}")]
    Length {
        /// "network name" or "password".
        what: &'static str,
        /// Bytes given.
        length: usize,
        /// Fewest bytes.
        min: usize,
        /// Most bytes.
        max: usize,
    },
    /// A character that the wire text cannot carry (a space, a control character or non-ASCII).
    #[error(
        "{what} has a character at byte {index} that the protocol cannot carry: use printable ASCII without spaces"
    )]
    Character {
        /// "network name" or "password".
        what: &'static str,
        /// Where it stands.
        index: usize,
    },
}

/// A network name (1 to 32 bytes) and its password (8 to 63 bytes), printable ASCII without spaces.
#[derive(Clone, PartialEq, Eq)]
pub struct Credentials {
    ssid: String,
    password: String,
}

impl Credentials {
    /// Checks both.
    ///
    /// # Errors
    /// A length or a character that cannot be sent.
    pub fn new(ssid: &str, password: &str) -> Result<Self, CredentialsError> {
        check("network name", ssid, 1, 32)?;
        check("password", password, 8, 63)?;
        Ok(Self {
            ssid: ssid.into(),
            password: password.into(),
        })
    }

    /// The network's name.
    #[must_use]
    pub fn ssid(&self) -> &str {
        &self.ssid
    }

    /// The password.
    #[must_use]
    pub fn password(&self) -> &str {
        &self.password
    }
}

/// The password stays out of logs.
impl fmt::Debug for Credentials {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Credentials")
            .field("ssid", &self.ssid)
            .finish_non_exhaustive()
    }
}

fn check(what: &'static str, text: &str, min: usize, max: usize) -> Result<(), CredentialsError> {
    if !(min..=max).contains(&text.len()) {
        return Err(CredentialsError::Length {
            what,
            length: text.len(),
            min,
            max,
        });
    }
    match text.bytes().position(|byte| !byte.is_ascii_graphic()) {
        Some(index) => Err(CredentialsError::Character { what, index }),
        None => Ok(()),
    }
}
