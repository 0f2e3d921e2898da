//! Texts in UTF-16 and UTF-32, which no reader of this project takes: recognised, so that the message names the conversion.

/// An encoding with two or four bytes a letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wide {
    name: &'static str,
    order: &'static str,
    /// The name for `iconv`. With a byte order mark it is without the order, so that the mark is removed.
    iconv: &'static str,
    /// The name for PowerShell, which also follows a byte order mark.
    power_shell: &'static str,
}

impl Wide {
    /// The encoding of a text, by its byte order mark or by the zeros of its first letters; `None` for any other file.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let wide = |name, order, iconv, power_shell| Some(Self { name, order, iconv, power_shell });
        let (little, big) = ("little-endian", "big-endian");
        let ascii = bytes.get(..32).filter(|start| start.is_ascii());
        // Which bytes of each group of four are zero.
        let zeros = ascii.and_then(|start| {
            let mut groups = start.as_chunks::<4>().0.iter().map(|group| group.map(|byte| byte == 0));
            let first = groups.next()?;
            groups.all(|group| group == first).then_some(first)
        });
        match (bytes, zeros) {
            // Before UTF-16: the mark of UTF-32 begins with that of UTF-16.
            ([0xFF, 0xFE, 0, 0, ..], _) => wide("UTF-32", little, "UTF-32", "utf32"),
            ([0, 0, 0xFE, 0xFF, ..], _) => wide("UTF-32", big, "UTF-32", "bigendianutf32"),
            ([0xFF, 0xFE, ..], _) => wide("UTF-16", little, "UTF-16", "Unicode"),
            ([0xFE, 0xFF, ..], _) => wide("UTF-16", big, "UTF-16", "BigEndianUnicode"),
            (_, Some([false, true, true, true])) => wide("UTF-32", little, "UTF-32LE", "utf32"),
            (_, Some([true, true, true, false])) => wide("UTF-32", big, "UTF-32BE", "bigendianutf32"),
            (_, Some([false, true, false, true])) => wide("UTF-16", little, "UTF-16LE", "Unicode"),
            (_, Some([true, false, true, false])) => wide("UTF-16", big, "UTF-16BE", "BigEndianUnicode"),
            _ => None,
        }
    }

    /// Cause and remedy of the problem of a file in this encoding where this kind of file is expected.
    #[must_use]
    pub fn problem(self, file: &str, expected: &str) -> [String; 2] {
        let Self { name, order, iconv, power_shell } = self;
        // A quote inside quotes: each shell has its own form.
        let (shell, windows) = (file.replace('\'', r"'\''"), file.replace('\'', "''"));
        [
            format!("expected {expected}, found a text in {name} ({order})"),
            format!(
                "save it as UTF-8 in an editor, or convert it: `iconv -f {iconv} -t UTF-8 '{shell}' > NEW_FILE`; in PowerShell: \
                 `Get-Content -Encoding {power_shell} '{windows}' | Set-Content -Encoding utf8 NEW_FILE`"
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_in_utf_32_is_not_called_utf_16() {
        let text = "title = \"a\"\nmachine = \"g1_example\"\n";
        let little: Vec<u8> = text.chars().flat_map(|letter| u32::from(letter).to_le_bytes()).collect();
        let big: Vec<u8> = text.chars().flat_map(|letter| u32::from(letter).to_be_bytes()).collect();
        let marked = |mark: &[u8], bytes: &[u8]| [mark, bytes].concat();
        for (bytes, order, iconv) in [
            (&little, "little-endian", "UTF-32LE"),
            (&big, "big-endian", "UTF-32BE"),
            (&marked(&[0xFF, 0xFE, 0, 0], &little), "little-endian", "UTF-32"),
            (&marked(&[0, 0, 0xFE, 0xFF], &big), "big-endian", "UTF-32"),
        ] {
            let [what, cure] = Wide::of(bytes).unwrap().problem("s.toml", "a text in UTF-8");
            assert_eq!(what, format!("expected a text in UTF-8, found a text in UTF-32 ({order})"));
            assert!(cure.contains(&format!("`iconv -f {iconv} -t UTF-8 's.toml' > NEW_FILE`")), "{cure}");
        }
        assert_eq!(Wide::of(text.as_bytes()), None);
        assert_eq!(Wide::of(&[0; 64]), None);
    }
}
