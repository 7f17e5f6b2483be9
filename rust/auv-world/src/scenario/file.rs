//! Reading and writing scenarios: TOML for people, JSON for programs.

use std::io::{self, ErrorKind, Read};
use std::path::Path;

use sha2::{Digest, Sha256};

use super::Scenario;
use crate::error::WorldError;
use crate::settings::suggest;

/// Larger files are refused (a real ocean of 40 levels takes about 12 MB).
const LARGEST_BYTES: u64 = 64 << 20;

impl Scenario {
    /// Reads and checks TOML.
    ///
    /// # Errors
    /// [`WorldError`] naming the key, its value and what was allowed.
    pub fn from_toml(text: &str) -> Result<Self, WorldError> {
        let wrong = |message: String| WorldError::Format { file: None, message };
        if text.len() as u64 > LARGEST_BYTES {
            return Err(wrong(format!("{} bytes of text: at most {LARGEST_BYTES} are read", text.len())));
        }
        let document = toml::Deserializer::parse(text).map_err(|error| wrong(error.to_string()))?;
        let scenario: Self =
            serde_path_to_error::deserialize(document).map_err(|error| wrong(explain(error.path(), error.inner())))?;
        scenario.check()?;
        Ok(scenario)
    }

    /// Reads and checks JSON, for other languages' mappings. In data `null` stands for NaN.
    ///
    /// # Errors
    /// [`WorldError`] naming the key, its value and what was allowed.
    pub fn from_json(text: &str) -> Result<Self, WorldError> {
        let mut document = serde_json::Deserializer::from_str(text);
        let scenario: Self = serde_path_to_error::deserialize(&mut document)
            .map_err(|error| WorldError::Format { file: None, message: explain(error.path(), error.inner()) })?;
        scenario.check()?;
        Ok(scenario)
    }

    /// Reads and checks a TOML file.
    ///
    /// # Errors
    /// [`WorldError`] naming the file, the key, its value and what was allowed.
    pub fn load(path: &Path) -> Result<Self, WorldError> {
        let failed =
            |error: io::Error| WorldError::File { file: path.into(), kind: error.kind(), message: error.to_string() };
        let wrong = |message: String| failed(io::Error::new(ErrorKind::InvalidData, message));
        let about = std::fs::metadata(path).map_err(failed)?;
        if about.is_dir() {
            return Err(failed(io::Error::new(ErrorKind::IsADirectory, "is a folder, not a file")));
        }
        // Devices and pipes may never end.
        if !about.is_file() {
            return Err(wrong("not a regular file".into()));
        }
        if about.len() > LARGEST_BYTES {
            return Err(wrong(format!("{} bytes: at most {LARGEST_BYTES} are read", about.len())));
        }
        let mut bytes = Vec::with_capacity(about.len() as usize);
        let file = std::fs::File::open(path).map_err(failed)?;
        file.take(LARGEST_BYTES).read_to_end(&mut bytes).map_err(failed)?;
        let text = String::from_utf8(bytes)
            .map_err(|error| wrong(format!("not UTF-8 text (byte {})", error.utf8_error().valid_up_to())))?;
        Self::from_toml(&text).map_err(|error| error.in_file(path))
    }

    /// The scenario as TOML.
    ///
    /// # Errors
    /// [`WorldError::Format`] if a value has no TOML.
    pub fn to_toml(&self) -> Result<String, WorldError> {
        toml::to_string(self).map_err(|error| WorldError::Format { file: None, message: error.to_string() })
    }

    /// The scenario as JSON.
    ///
    /// # Errors
    /// [`WorldError::Format`] if a value has no JSON.
    pub fn to_json(&self) -> Result<String, WorldError> {
        serde_json::to_string(self).map_err(|error| WorldError::Format { file: None, message: error.to_string() })
    }

    /// Writes TOML beside the target first and then renames it, so that no broken file is left; nor is
    /// anything else if that fails.
    ///
    /// # Errors
    /// [`WorldError::File`] if the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), WorldError> {
        let text = self.to_toml()?;
        let mut name = path.file_name().unwrap_or_default().to_os_string();
        name.push(".part");
        let part = path.with_file_name(name);
        std::fs::write(&part, text).and_then(|()| std::fs::rename(&part, path)).map_err(|error| {
            std::fs::remove_file(&part).ok();
            WorldError::File { file: path.into(), kind: error.kind(), message: error.to_string() }
        })
    }

    /// SHA-256 of the TOML text: two scenarios with one hash make one world.
    ///
    /// # Errors
    /// As [`Scenario::to_toml`].
    pub fn hash(&self) -> Result<String, WorldError> {
        let digest = Sha256::digest(self.to_toml()?.as_bytes());
        Ok(digest.iter().map(|byte| format!("{byte:02x}")).collect())
    }
}

fn explain(path: &serde_path_to_error::Path, error: &impl std::fmt::Display) -> String {
    let error = error.to_string();
    let error = error.trim_end();
    suggest(match path.to_string().as_str() {
        "." => error.to_string(),
        path => format!("{path}: {error}"),
    })
}
