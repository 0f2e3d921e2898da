//! A session with a STEP 7 program.

use std::path::Path;

use super::failure::Failure;
use super::session::Session;
use crate::plc::step7;

impl Session {
    /// The same session with the STEP 7 program in a folder.
    ///
    /// # Errors
    /// The folder cannot be read, or its sources have findings.
    pub fn with_step7(self, folder: impl AsRef<Path>) -> Result<Self, Failure> {
        let folder = folder.as_ref();
        let name = folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        Ok(self.with_program(step7::load(folder, &name)?.boxed()))
    }
}
