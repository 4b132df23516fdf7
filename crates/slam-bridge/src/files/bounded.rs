//! A reader that ends in an error after so many bytes: a small compressed file may unpack to any size, and a device never ends.

use std::io::{self, BufRead, ErrorKind, Read};

/// Hands out at most `left` bytes; then an error of [`ErrorKind::FileTooLarge`] if there are more.
pub(super) struct Bounded<R> {
    inner: R,
    left: u64,
}

impl<R: BufRead> Bounded<R> {
    pub(super) fn new(inner: R, most: u64) -> Self {
        Self { inner, left: most }
    }
}

impl<R: BufRead> BufRead for Bounded<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        let bytes = self.inner.fill_buf()?;
        if self.left == 0 && !bytes.is_empty() {
            return Err(ErrorKind::FileTooLarge.into());
        }
        let allowed = usize::try_from(self.left).unwrap_or(usize::MAX);
        Ok(&bytes[..bytes.len().min(allowed)])
    }

    fn consume(&mut self, amount: usize) {
        self.left = self.left.saturating_sub(amount as u64);
        self.inner.consume(amount);
    }
}

impl<R: BufRead> Read for Bounded<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let bytes = self.fill_buf()?;
        let count = bytes.len().min(to.len());
        to[..count].copy_from_slice(&bytes[..count]);
        self.consume(count);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_fits_is_read_and_one_byte_more_is_refused(bytes in prop::collection::vec(any::<u8>(), 0..60), most in 0_u64..60, buffer in 1_usize..9) {
            let inner = io::BufReader::with_capacity(buffer, &bytes[..]);
            let mut read = Vec::new();
            let result = Bounded::new(inner, most).read_to_end(&mut read);
            prop_assert_eq!(&read[..], &bytes[..bytes.len().min(most as usize)]);
            if bytes.len() as u64 <= most {
                prop_assert_eq!(result.unwrap(), bytes.len());
            } else {
                prop_assert_eq!(result.unwrap_err().kind(), ErrorKind::FileTooLarge);
            }
        }
    }
}
