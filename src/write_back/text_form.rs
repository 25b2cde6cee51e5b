//! The form of a text file that a reader does not see: its mark at the begin, and its line breaks.

/// Mark of UTF-8 at the begin of a file.
const MARK: char = '\u{feff}';

/// Which line breaks a file has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Breaks {
    /// LF, or several kinds.
    Plain,
    /// CR and LF.
    Windows,
    /// CR alone.
    OldMac,
}

/// The form of a file. A shader tree reads it without the mark, and with LF where lines end in CR alone (`source/read.rs`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct TextForm {
    has_mark: bool,
    breaks: Breaks,
}

impl TextForm {
    /// The form of the text of a file.
    pub(super) fn of(text: &str) -> Self {
        let windows = text.matches("\r\n").count();
        let (all, carriages) = (text.matches('\n').count(), text.matches('\r').count());
        let breaks = match (all, carriages) {
            (0, 1..) => Breaks::OldMac,
            (1.., _) if windows == all && windows == carriages => Breaks::Windows,
            _ => Breaks::Plain,
        };
        Self { has_mark: text.starts_with(MARK), breaks }
    }

    /// The text as a shader tree reads it.
    pub(super) fn read(self, text: &str) -> String {
        let text = text.strip_prefix(MARK).unwrap_or(text);
        if self.breaks == Breaks::OldMac { text.replace('\r', "\n") } else { text.to_owned() }
    }

    /// A text that a shader tree has read, in this form. New lines, which end in LF, get the line breaks of the file.
    pub(super) fn write(self, text: &str) -> String {
        let text = match self.breaks {
            Breaks::Plain => text.to_owned(),
            Breaks::Windows => text.replace("\r\n", "\n").replace('\n', "\r\n"),
            Breaks::OldMac => text.replace('\n', "\r"),
        };
        if self.has_mark { format!("{MARK}{text}") } else { text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_keeps_the_form_of_its_file() {
        for (on_disk, read, written) in [
            ("a\nb\n", "a\nb\n", "a\nnew\nb\n"),
            ("a\r\nb\r\n", "a\r\nb\r\n", "a\r\nnew\r\nb\r\n"),
            ("\u{feff}a\rb\r", "a\nb\n", "\u{feff}a\rnew\rb\r"),
            ("\u{feff}a\nb\n", "a\nb\n", "\u{feff}a\nnew\nb\n"),
            ("a\r\nb\n", "a\r\nb\n", "a\r\nnew\nb\n"),
            ("ab", "ab", "anew\nb"),
        ] {
            let form = TextForm::of(on_disk);
            assert_eq!((form.read(on_disk).as_str(), form.write(read).as_str()), (read, on_disk), "{on_disk:?}");
            let typed = read.replacen('b', "new\nb", 1);
            assert_eq!(form.write(&typed), written, "{on_disk:?}");
        }
    }
}
