//! Parses URIs: data URIs and paths. Refuses all others.

use std::path::PathBuf;

use crate::scene::error::Problem;

/// The target of a URI.
#[derive(Debug, PartialEq, Eq)]
pub enum UriTarget {
    /// The bytes of a data URI.
    Data(Vec<u8>),
    /// A path as written, percent-decoded, relative to the model's folder unless absolute.
    File(PathBuf),
}

/// Parses a URI. Refuses all schemes except `data:`, and paths out of the model's folder unless `allow_outside`.
pub fn parse(uri: &str, place: &str, allow_outside: bool) -> Result<UriTarget, Problem> {
    if let Some(scheme) = scheme(uri) {
        if scheme.eq_ignore_ascii_case("data") {
            return decode_data(&uri[scheme.len() + 1..], place).map(UriTarget::Data);
        }
        return Err(Problem::Scheme { place: place.into(), uri: shorten(uri), scheme: scheme.into() });
    }
    let decoded = percent_decode(uri).and_then(|bytes| String::from_utf8(bytes).ok());
    let Some(path) = decoded.filter(|path| !path.is_empty()) else {
        return Err(Problem::invalid(place, "a relative path in percent-encoded UTF-8", format!("`{}`", shorten(uri))));
    };
    if !allow_outside && leaves_folder(&path) {
        let found = "a path that leaves it".to_owned();
        return Err(Problem::Outside { place: place.into(), uri: shorten(&path), found });
    }
    Ok(UriTarget::File(PathBuf::from(path)))
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
    let (decoded, kind) = if header.ends_with(";base64") {
        (base64_decode(body), "base64")
    } else {
        (percent_decode(body), "percent-encoded")
    };
    decoded.ok_or_else(|| Problem::invalid(place, format!("{kind} data in a data URI"), "characters that are not"))
}

/// Decodes `%XX`. Returns `None` if digits are missing.
fn percent_decode(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len());
    let mut bytes = text.bytes();
    let digit = |bytes: &mut std::str::Bytes<'_>| char::from(bytes.next()?).to_digit(16);
    while let Some(byte) = bytes.next() {
        let decoded = match byte {
            b'%' => u8::try_from(digit(&mut bytes)? * 16 + digit(&mut bytes)?).ok()?,
            other => other,
        };
        out.push(decoded);
    }
    Some(out)
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
        assert_eq!(parse("a%20b/%C3%A9.bin", "", false).unwrap(), UriTarget::File("a b/\u{e9}.bin".into()));
        assert_eq!(parse("x/../y.bin", "", false).unwrap(), UriTarget::File("x/../y.bin".into()));
        assert_eq!(parse("data:text/plain,a%20b", "", false).unwrap(), UriTarget::Data(b"a b".to_vec()));
        for bad in ["%", "%4", "%zz", "%ff.bin", ""] {
            assert!(matches!(parse(bad, "", false), Err(Problem::Invalid { .. })), "{bad}");
        }
        assert!(matches!(parse("data:x", "", false), Err(Problem::Invalid { .. })));
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
