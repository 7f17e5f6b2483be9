//! Settings from other languages: read so that an error names the key, and helps with wrong names.

use serde::de::DeserializeOwned;
use serde_json::Value;

/// Less alike than this is no help (Jaro-Winkler similarity).
const ALIKE: f64 = 0.7;

/// Reads settings; the error names the key.
///
/// # Errors
/// What is wrong, in words.
pub fn read<T: DeserializeOwned>(value: Value) -> Result<T, String> {
    serde_path_to_error::deserialize(value).map_err(|error| {
        let (path, inner) = (error.path().to_string(), error.inner().to_string());
        // An unknown field is named by the message itself.
        if path == "." || inner.starts_with("unknown field") { inner } else { format!("{path}: {inner}") }
    })
}

/// The known name most like `name`, if one is alike.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    known
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&name, candidate), candidate))
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

/// Adds the nearest known name to serde's message about an unknown field or variant.
pub fn suggest(message: String) -> String {
    let Some(start) = ["unknown field `", "unknown variant `"].iter().find_map(|words| message.find(words)) else {
        return message;
    };
    // "unknown field `a`, expected one of `b`, `c`": every second piece is a name.
    let mut names = message[start..].split('`').skip(1).step_by(2);
    let unknown = names.next().unwrap_or_default();
    match nearest(unknown, names) {
        Some(name) => format!("{message}; did you mean `{name}`?"),
        None => message,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::Parameters;
    use serde_json::json;

    fn message(value: Value) -> String {
        suggest(read::<Parameters>(value).unwrap_err())
    }

    #[test]
    fn names_the_key_and_the_nearest_name() {
        assert_eq!(message(json!({"obstacles": "x"})), "obstacles: invalid type: string \"x\", expected usize");
        let unknown = message(json!({"obstacle": 3}));
        assert!(unknown.starts_with("unknown field `obstacle`, expected one of `difficulty`"), "{unknown}");
        assert!(unknown.ends_with("; did you mean `obstacles`?"), "{unknown}");
        let variant = message(json!({"difficulty": "nomal"}));
        assert!(variant.starts_with("difficulty: ") && variant.ends_with("; did you mean `normal`?"), "{variant}");
        assert!(!message(json!({"qqq": 3})).contains("did you mean"));
    }
}
