//! Numbers of a grid: a list, or packed as base64 so that real oceans fit into one text file.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Deserializer, Serialize};

/// What a packed array starts with: little-endian 32-bit floats in base64 follow.
const PREFIX: &str = "f32le:";

/// The values of a grid in C order; NaN = missing.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Data {
    /// Written out; NaN is `nan` in TOML and `null` in JSON.
    Numbers(#[serde(deserialize_with = "numbers")] Vec<f64>),
    /// "f32le:" and base64.
    Packed(String),
}

fn numbers<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let numbers = Vec::<Option<f64>>::deserialize(deserializer)?;
    Ok(numbers.into_iter().map(|number| number.unwrap_or(f64::NAN)).collect())
}

/// Two arrays are equal when their values are, missing ones included.
impl PartialEq for Data {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Packed(a), Self::Packed(b)) => a == b,
            (Self::Numbers(a), Self::Numbers(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || (a.is_nan() && b.is_nan()))
            }
            _ => false,
        }
    }
}

impl Data {
    /// Packs values as 32-bit floats.
    pub fn pack(values: &[f32]) -> Self {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        Self::Packed(format!("{PREFIX}{}", STANDARD.encode(bytes)))
    }

    /// The values as 32-bit floats, or what is wrong with them.
    pub fn values(&self) -> Result<Vec<f32>, String> {
        let text = match self {
            Self::Numbers(numbers) => return Ok(numbers.iter().map(|&value| value as f32).collect()),
            Self::Packed(text) => text,
        };
        let encoded = text
            .strip_prefix(PREFIX)
            .ok_or_else(|| format!("must be a list of numbers or a string that starts with \"{PREFIX}\""))?;
        let bytes = STANDARD.decode(encoded).map_err(|error| format!("must be valid base64: {error}"))?;
        if bytes.len() % 4 != 0 {
            return Err(format!("must hold whole 32-bit floats, has {} bytes", bytes.len()));
        }
        Ok(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packs_and_unpacks() {
        let values = [1.5_f32, -2.0, f32::NAN, 1e-30];
        let unpacked = Data::pack(&values).values().unwrap();
        assert_eq!(values.map(f32::to_bits).to_vec(), unpacked.iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        assert!(Data::Packed("f32le:!".into()).values().is_err());
        assert!(Data::Packed("AAAA".into()).values().is_err());
    }

    #[test]
    fn missing_values_survive_json() {
        let data = Data::Numbers(vec![1.0, f64::NAN]);
        let text = serde_json::to_string(&data).unwrap();
        assert_eq!((text.as_str(), &serde_json::from_str::<Data>(&text).unwrap()), ("[1.0,null]", &data));
    }
}
