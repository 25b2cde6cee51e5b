//! Parses URIs: data URIs and paths. Refuses all others.

use std::path::PathBuf;

use crate::scene::error::Problem;

/// The target of a URI.
#[derive(Debug, PartialEq, Eq)]
pub enum UriTarget {
    /// The bytes of a data URI.
    Data(Vec<u8>),
    /// Paths, relative to the model's folder unless absolute, of which the first that exists is meant: as URIs are written, and as
    /// programs write them that know only paths, with backslashes or a `%` that stands for itself.
    File(Vec<PathBuf>),
}

/// Parses a URI. Refuses all schemes except `data:`, and paths out of the model's folder unless `allow_outside`.
pub fn parse(uri: &str, place: &str, allow_outside: bool) -> Result<UriTarget, Problem> {
    if let Some(scheme) = scheme(uri) {
        if scheme.eq_ignore_ascii_case("data") {
            return decode_data(&uri[scheme.len() + 1..], place).map(UriTarget::Data);
        }
        return Err(Problem::Scheme { place: place.into(), uri: shorten(uri), scheme: scheme.into() });
    }
    if uri.is_empty() {
        return Err(Problem::invalid(place, "a relative path", "an empty text"));
    }
    let mut paths = Vec::new();
    for path in [String::from_utf8(percent_decode(uri)).ok(), Some(uri.to_owned())].into_iter().flatten() {
        if !allow_outside && leaves_folder(&path) {
            let found = "a path that leaves it".to_owned();
            return Err(Problem::Outside { place: place.into(), uri: shorten(&path), found });
        }
        for path in [PathBuf::from(&path), PathBuf::from(path.replace('\\', "/"))] {
            if !paths.contains(&path) {
                paths.push(path);
            }
        }
    }
    Ok(UriTarget::File(paths))
}

/// Whether a URI holds its data.
pub fn is_data(uri: &str) -> bool {
    scheme(uri).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data"))
}

/// The scheme before the colon. A single letter is a Windows drive.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let valid = scheme.starts_with(|c: char| c.is_ascii_alphabetic())
        && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    (valid && scheme.len() > 1).then_some(scheme)
}

/// Whether a path is absolute or leaves its folder on any system, since a model may come from another system.
fn leaves_folder(path: &str) -> bool {
    let drive = path.as_bytes().get(1) == Some(&b':');
    if drive || path.starts_with(['/', '\\']) {
        return true;
    }
    let mut depth = 0_i64;
    for part in path.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => depth -= 1,
            _ => depth += 1,
        }
        if depth < 0 {
            return true;
        }
    }
    false
}

/// Decodes the text after `data:`.
fn decode_data(data: &str, place: &str) -> Result<Vec<u8>, Problem> {
    let Some((header, body)) = data.split_once(',') else {
        return Err(Problem::invalid(
            place,
            "a data URI with a comma before its data",
            format!("`data:{}`", shorten(data)),
        ));
    };
    if !header.to_ascii_lowercase().ends_with(";base64") {
        return Ok(percent_decode(body));
    }
    base64_decode(body).ok_or_else(|| Problem::invalid(place, "base64 data in a data URI", "characters that are not"))
}

/// Decodes `%XX`. A `%` without two digits stands for itself.
fn percent_decode(text: &str) -> Vec<u8> {
    let mut out = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    let digit = |byte: u8| char::from(byte).to_digit(16);
    while let [first, after @ ..] = rest {
        let pair = after.first_chunk().filter(|_| *first == b'%').and_then(|[a, b]| Some(digit(*a)? * 16 + digit(*b)?));
        out.push(pair.map_or(*first, |value| value as u8));
        rest = if pair.is_some() { &after[2..] } else { after };
    }
    out
}

/// Decodes base64 in the standard or URL alphabet, padded or not. Returns `None` on anything else.
fn base64_decode(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    if text.len() % 4 == 1 {
        return None;
    }
    let mut out = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut bits = 0_u32;
        for &symbol in group {
            let value = match symbol {
                b'A'..=b'Z' => symbol - b'A',
                b'a'..=b'z' => symbol - b'a' + 26,
                b'0'..=b'9' => symbol - b'0' + 52,
                b'+' | b'-' => 62,
                b'/' | b'_' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(value);
        }
        bits <<= 6 * (4 - group.len());
        out.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Some(out)
}

/// Shortens a URI for a message.
fn shorten(uri: &str) -> String {
    match uri.char_indices().nth(120) {
        Some((end, _)) => format!("{}...", &uri[..end]),
        None => uri.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_every_length() {
        for (text, bytes) in
            [("", ""), ("Zg==", "f"), ("Zm8=", "fo"), ("Zm9v", "foo"), ("Zm9vYg", "foob"), ("Zm9vYmE=", "fooba")]
        {
            assert_eq!(base64_decode(text).as_deref(), Some(bytes.as_bytes()), "{text}");
        }
        assert_eq!(base64_decode("-_+/"), Some(vec![0xfb, 0xff, 0xbf]));
        for bad in ["Z", "Zm9vY", "Zm 9", "Zm9\u{e9}"] {
            assert_eq!(base64_decode(bad), None, "{bad}");
        }
    }

    #[test]
    fn paths_are_percent_decoded() {
        let paths = |uri: &str| match parse(uri, "", false).unwrap() {
            UriTarget::File(paths) => paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
            UriTarget::Data(bytes) => panic!("{bytes:?}"),
        };
        assert_eq!(paths("a%20b/%C3%A9.bin"), ["a b/\u{e9}.bin", "a%20b/%C3%A9.bin"]);
        assert_eq!(paths("x/../y.bin"), ["x/../y.bin"]);
        // As programs write them that know only paths.
        assert_eq!(paths("tex\\50%.png"), ["tex\\50%.png", "tex/50%.png"]);
        for odd in ["%", "%4", "%zz"] {
            assert_eq!(paths(odd), [odd]);
        }
        assert_eq!(paths("%ff.bin"), ["%ff.bin"]);
        for data in ["data:text/plain,a%20b", "DATA:,a%20b", "Data:;BASE64,YSBi"] {
            assert_eq!(parse(data, "", false).unwrap(), UriTarget::Data(b"a b".to_vec()));
        }
        for bad in ["", "data:x", "data:;base64,*"] {
            assert!(matches!(parse(bad, "", false), Err(Problem::Invalid { .. })), "{bad}");
        }
    }

    #[test]
    fn ways_out_need_leave_and_schemes_never_get_it() {
        for uri in ["/etc/x", "../x", "a/../../x", "%2e%2e/x", "..\\x", "C:\\x", "C:x", "\\\\server\\x", "a\\..\\..\\x"]
        {
            assert!(matches!(parse(uri, "", false), Err(Problem::Outside { .. })), "{uri}");
            assert!(matches!(parse(uri, "", true), Ok(UriTarget::File(_))), "{uri}");
        }
        for uri in ["http://x/y.png", "file:///etc/x", "FTP:x", "blob:x"] {
            assert!(matches!(parse(uri, "", true), Err(Problem::Scheme { .. })), "{uri}");
        }
    }
}
