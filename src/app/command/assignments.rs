//! The values of the command `set` as `path=value`, in each of their forms.

use serde_json::Value;

/// The assignments in `"path=value"`, a list of these, or an object of paths and values, which may be nested.
///
/// # Errors
/// A message about what is none of these.
pub(super) fn assignments(values: &Value) -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    match values {
        Value::String(text) => found.push(text.clone()),
        Value::Array(list) => {
            for entry in list {
                let text = entry.as_str().ok_or_else(|| format!("`values`: {entry} is no \"path=value\""))?;
                found.push(text.to_owned());
            }
        }
        Value::Object(_) => flatten("", values, &mut found)?,
        Value::Null => {}
        other => return Err(format!("`values` cannot be {other}; {FORMS}")),
    }
    if found.is_empty() { Err(format!("`set` needs `values`: {FORMS}")) } else { Ok(found) }
}

const FORMS: &str = "it takes \"view.ev=1\", [\"view.ev=1\", \"mode=d\"] or {\"view.ev\": 1}";

fn flatten(path: &str, value: &Value, found: &mut Vec<String>) -> Result<(), String> {
    if let Value::Object(map) = value {
        let below = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        return map.iter().try_for_each(|(key, value)| flatten(&below(key), value, found));
    }
    found.push(format!("{path}={}", toml_of(value).ok_or_else(|| format!("{path} cannot be {value}"))?));
    Ok(())
}

/// A JSON value as the TOML that settings take. `None` for null and for anything that contains it.
fn toml_of(value: &Value) -> Option<toml::Value> {
    Some(match value {
        Value::Bool(on) => toml::Value::Boolean(*on),
        Value::Number(number) => match number.as_i64() {
            Some(whole) => toml::Value::Integer(whole),
            None => toml::Value::Float(number.as_f64()?),
        },
        Value::String(text) => toml::Value::String(text.clone()),
        Value::Array(list) => toml::Value::Array(list.iter().map(toml_of).collect::<Option<_>>()?),
        Value::Null | Value::Object(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::settings::Settings;

    #[test]
    fn every_form_says_the_same() {
        for values in
            [json!("view.ev=1.5"), json!(["view.ev=1.5"]), json!({"view.ev": 1.5}), json!({"view": {"ev": 1.5}})]
        {
            let mut settings = Settings::default();
            for assignment in assignments(&values).unwrap() {
                settings.assign(&assignment).unwrap();
            }
            assert_eq!(settings.view.ev, 1.5, "{values}");
        }
    }

    #[test]
    fn values_of_all_types_arrive() {
        let values = json!({"mode": "d", "lights": {"orbit.0.color": [1, 0.5, 0], "rect": {"enabled": true}},
            "environment.name": "a \"b\" \\ c", "view.msaa": 1, "NDF": "Beckmann"});
        let mut settings = Settings::default();
        for assignment in assignments(&values).unwrap() {
            settings.assign(&assignment).unwrap();
        }
        assert_eq!(settings.lights.orbit[0].color, [1.0, 0.5, 0.0]);
        assert!(settings.lights.rect.enabled && settings.mode == "d" && settings.view.msaa == 1);
        assert_eq!(settings.environment.name, "a \"b\" \\ c");
        for (values, part) in
            [(json!(1), "cannot be 1"), (json!([1]), "1 is no"), (json!({"a": null}), "a cannot be null")]
        {
            let error = assignments(&values).unwrap_err();
            assert!(error.contains(part), "{error}");
        }
        assert!(assignments(&json!({})).is_err() && assignments(&Value::Null).is_err());
    }
}
