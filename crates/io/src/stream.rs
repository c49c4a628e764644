//! Bytes from a file or from memory, read forward, plain or decompressed, with a bound on how many can come.

use crate::{Cancel, ReadError, cancel::is_cancelled};
use flate2::bufread::{MultiGzDecoder, ZlibDecoder};
use std::{
    fs::{self, File},
    io::{self, BufRead, BufReader, Cursor, Read},
    path::Path,
};

/// Most bytes of a text header.
pub(crate) const MAX_HEADER_BYTES: usize = 1 << 20;

/// DEFLATE encodes 258 bytes in two bits at best.
const MAX_INFLATION: u64 = 1032;

const GZIP_MAGIC: [u8; 2] = [0x1f, 0x8b];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Compression {
    Gzip,
    Zlib,
}

impl Compression {
    fn name(self) -> &'static str {
        match self {
            Self::Gzip => "gzip",
            Self::Zlib => "zlib",
        }
    }
}

/// Bytes that come one after another.
pub(crate) struct Stream<'a> {
    reader: Box<dyn BufRead + 'a>,
    /// Exact for plain bytes, an upper bound for decompressed ones.
    remaining: u64,
    compression: Option<Compression>,
}

impl Stream<'static> {
    /// Opens a regular file, to be read until that is given up. Anything else is refused before it is opened, since opening a pipe
    /// may block.
    pub(crate) fn open(path: &Path, cancel: &Cancel) -> Result<Self, ReadError> {
        let metadata = fs::metadata(path).map_err(ReadError::io)?;
        if metadata.is_dir() {
            return Err(ReadError::NotAFile { found: "directory" });
        }
        if !metadata.is_file() {
            return Err(ReadError::NotAFile { found: "device or pipe" });
        }
        if metadata.len() == 0 {
            return Err(ReadError::Empty);
        }
        let file = File::open(path).map_err(ReadError::io)?;
        let reader = Box::new(BufReader::with_capacity(1 << 16, cancel.watch(file)));
        Ok(Self { reader, remaining: metadata.len(), compression: None })
    }
}

impl<'a> Stream<'a> {
    pub(crate) fn of_bytes(bytes: &'a [u8]) -> Result<Self, ReadError> {
        if bytes.is_empty() {
            return Err(ReadError::Empty);
        }
        Ok(Self { reader: Box::new(bytes), remaining: bytes.len() as u64, compression: None })
    }

    /// Most bytes that can still come; exact if the stream is plain.
    pub(crate) fn remaining(&self) -> u64 {
        self.remaining
    }

    /// Whether the bytes come as they are stored.
    pub(crate) fn is_plain(&self) -> bool {
        self.compression.is_none()
    }

    /// Decompresses what follows.
    pub(crate) fn decompress(self, compression: Compression) -> Self {
        let reader: Box<dyn BufRead + 'a> = match compression {
            Compression::Gzip => {
                Box::new(BufReader::with_capacity(1 << 16, MultiGzDecoder::new(self.reader)))
            }
            Compression::Zlib => Box::new(BufReader::with_capacity(1 << 16, ZlibDecoder::new(self.reader))),
        };
        let remaining = self.remaining.saturating_mul(MAX_INFLATION);
        Self { reader, remaining, compression: Some(compression) }
    }

    /// Decompresses if the next bytes are gzip's signature.
    pub(crate) fn gunzip_by_magic(mut self) -> Result<Self, ReadError> {
        if self.peek(GZIP_MAGIC.len())? == GZIP_MAGIC {
            Ok(self.decompress(Compression::Gzip))
        } else {
            Ok(self)
        }
    }

    /// Up to `count` of the next bytes, which stay to be read.
    pub(crate) fn peek(&mut self, count: usize) -> Result<Vec<u8>, ReadError> {
        let mut start = vec![0; count];
        let found = self.fill(&mut start)?;
        start.truncate(found);
        self.remaining += found as u64;
        let rest = std::mem::replace(&mut self.reader, Box::new(io::empty()));
        self.reader = Box::new(Cursor::new(start.clone()).chain(rest));
        Ok(start)
    }

    /// Reads until the buffer is full or the stream ends; the number of bytes read. A compressed stream that
    /// breaks off counts as one that ends.
    pub(crate) fn fill(&mut self, buffer: &mut [u8]) -> Result<usize, ReadError> {
        let mut filled = 0;
        while filled < buffer.len() {
            match self.reader.read(&mut buffer[filled..]) {
                Ok(0) => break,
                Ok(count) => filled += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => break,
                Err(error) => return Err(self.fault(error)),
            }
        }
        self.remaining = self.remaining.saturating_sub(filled as u64);
        Ok(filled)
    }

    /// Reads exactly `count` bytes; `what` names them if they are not there.
    pub(crate) fn take_exact(&mut self, count: usize, what: &'static str) -> Result<Vec<u8>, ReadError> {
        let mut bytes = vec![0; count];
        let found = self.fill(&mut bytes)?;
        if found < count {
            return Err(ReadError::Truncated {
                what,
                expected_bytes: count as u64,
                found_bytes: found as u64,
            });
        }
        Ok(bytes)
    }

    /// Passes over `count` bytes.
    pub(crate) fn skip(&mut self, count: u64) -> Result<(), ReadError> {
        let truncated = |found_bytes| ReadError::Truncated {
            what: "part before the voxel data",
            expected_bytes: count,
            found_bytes,
        };
        if count > self.remaining {
            return Err(truncated(self.remaining));
        }
        let skipped = match io::copy(&mut self.reader.by_ref().take(count), &mut io::sink()) {
            Ok(skipped) => skipped,
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => return Err(truncated(0)),
            Err(error) => return Err(self.fault(error)),
        };
        self.remaining -= skipped.min(self.remaining);
        if skipped < count { Err(truncated(skipped)) } else { Ok(()) }
    }

    /// Passes over the rest of `count` lines.
    pub(crate) fn skip_lines(&mut self, count: u64) -> Result<(), ReadError> {
        for _ in 0..count {
            match self.reader.skip_until(b'\n') {
                Ok(0) => {
                    return Err(ReadError::Truncated {
                        what: "part before the voxel data",
                        expected_bytes: 1,
                        found_bytes: 0,
                    });
                }
                Ok(skipped) => self.remaining = self.remaining.saturating_sub(skipped as u64),
                Err(error) => return Err(self.fault(error)),
            }
        }
        Ok(())
    }

    /// The next line of a text header without its end; `None` at the end of the stream. `budget_bytes` is what the header
    /// may still take, and shrinks.
    pub(crate) fn header_line(&mut self, budget_bytes: &mut usize) -> Result<Option<String>, ReadError> {
        let mut line = Vec::new();
        let read = self.reader.by_ref().take(*budget_bytes as u64 + 1).read_until(b'\n', &mut line);
        let count = match read {
            Ok(count) => count,
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => line.len(),
            Err(error) => return Err(self.fault(error)),
        };
        self.remaining = self.remaining.saturating_sub(count as u64);
        if count > *budget_bytes {
            return Err(ReadError::HeaderTooLong { limit_bytes: MAX_HEADER_BYTES });
        }
        *budget_bytes -= count;
        if count == 0 {
            return Ok(None);
        }
        while line.last().is_some_and(|byte| matches!(byte, b'\n' | b'\r')) {
            line.pop();
        }
        Ok(Some(String::from_utf8_lossy(&line).into_owned()))
    }

    /// The next word of a text: what stands between white space or commas. `None` at the end.
    pub(crate) fn word(&mut self) -> Result<Option<String>, ReadError> {
        const LONGEST: usize = 64;
        let mut word = Vec::new();
        loop {
            let buffer = match self.reader.fill_buf() {
                Ok(buffer) => buffer,
                Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => &[],
                Err(error) => return Err(self.fault(error)),
            };
            if buffer.is_empty() {
                break;
            }
            let is_gap = |byte: &u8| byte.is_ascii_whitespace() || *byte == b',';
            let gap = if word.is_empty() { buffer.iter().take_while(|b| is_gap(b)).count() } else { 0 };
            let letters = buffer[gap..].iter().take_while(|b| !is_gap(b)).count();
            let kept = letters.min(LONGEST + 1 - word.len());
            word.extend_from_slice(&buffer[gap..gap + kept]);
            let ended = gap + letters < buffer.len() && !word.is_empty();
            let used = gap + letters;
            self.reader.consume(used);
            self.remaining = self.remaining.saturating_sub(used as u64);
            if ended || word.len() > LONGEST {
                break;
            }
        }
        Ok((!word.is_empty()).then(|| String::from_utf8_lossy(&word).into_owned()))
    }

    /// Whether anything follows; also makes a decompressor check its checksum.
    pub(crate) fn has_more(&mut self) -> io::Result<bool> {
        Ok(self.reader.read(&mut [0])? > 0)
    }

    fn fault(&self, error: io::Error) -> ReadError {
        use io::ErrorKind::{InvalidData, InvalidInput};
        match self.compression {
            Some(compression)
                if matches!(error.kind(), InvalidData | InvalidInput | io::ErrorKind::Other)
                    && !is_cancelled(&error) =>
            {
                ReadError::Corrupt { encoding: compression.name(), detail: error.to_string() }
            }
            _ => ReadError::io(error),
        }
    }
}
