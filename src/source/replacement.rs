//! Outputs: a file is complete or not changed at all.
//!
//! A [`Replacement`] is a new file beside its target, and takes its place when it is complete. It exists only while it is written, after the
//! run, so a signal during the run leaves nothing behind. A full disk, a failed command or a kill leaves the old file; after a kill while the
//! new file is written, it stays beside the old one (`.NAME.PROCESS-NUMBER.new`) and can be deleted. Devices and pipes have no old content:
//! they are written directly. So are the streams that the shell opened (`/dev/stdout`, `/dev/stderr`, `/dev/fd/N`), also where a file is
//! behind them: it belongs to the shell, and with `>>` it keeps its content.

use std::ffi::OsString;
use std::fs::{File, OpenOptions, Permissions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Problem, unwritable};

/// Tells apart the files that this process writes at the same time.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// A file that is being written, and takes the place of another one when it is complete.
#[derive(Debug)]
pub struct Replacement {
    /// The target as the user named it, for messages.
    named: PathBuf,
    /// The target; a symbolic link is followed, so that it stays a link.
    target: PathBuf,
    /// Those of the file that it replaces.
    permissions: Option<Permissions>,
    destination: Destination,
}

/// Where the text goes.
#[derive(Debug)]
enum Destination {
    /// A device, a pipe or an open stream.
    Direct(File),
    /// A file beside the target, which does not exist yet.
    NewFile,
    /// A file beside the target.
    Beside(PathBuf, File),
    /// It has taken the place of the target.
    Placed,
}

impl Replacement {
    /// Tests whether the new file can be created. The target is not changed.
    ///
    /// # Errors
    /// The folder of the target does not exist or cannot be written, or the target is a folder.
    pub fn begin(path: &Path) -> Result<Self, Problem> {
        Self::open(path).map_err(|error| unwritable(path, &error))
    }

    fn open(path: &Path) -> io::Result<Self> {
        let named = path.to_owned();
        if let Some(file) = stream(path) {
            return Ok(Self {
                target: named.clone(),
                named,
                permissions: None,
                destination: Destination::Direct(file?),
            });
        }
        let target = target(path);
        let old = std::fs::metadata(&target).ok();
        if old.as_ref().is_some_and(std::fs::Metadata::is_dir) {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        if old.as_ref().is_some_and(|old| !old.is_file()) {
            let file = OpenOptions::new().write(true).open(&target)?;
            return Ok(Self { named, target, permissions: None, destination: Destination::Direct(file) });
        }
        if old.is_some() {
            // A file that its owner has protected is not replaced, although the folder would permit it.
            OpenOptions::new().write(true).open(&target)?;
        }
        let (beside, file) = create_beside(&target)?;
        drop(file);
        std::fs::remove_file(beside)?;
        Ok(Self { named, target, permissions: old.map(|old| old.permissions()), destination: Destination::NewFile })
    }

    /// The file to which the text goes.
    fn file(&mut self) -> io::Result<&mut File> {
        if matches!(self.destination, Destination::NewFile) {
            let (beside, file) = create_beside(&self.target)?;
            self.destination = Destination::Beside(beside, file);
        }
        match &mut self.destination {
            Destination::Direct(file) => Ok(file),
            Destination::Beside(_, file) => {
                if let Some(permissions) = self.permissions.take() {
                    file.set_permissions(permissions)?;
                }
                Ok(file)
            }
            Destination::NewFile | Destination::Placed => Err(io::ErrorKind::NotFound.into()),
        }
    }

    /// Adds text to the new file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, text: &str) -> Result<(), Problem> {
        self.write_bytes(text.as_bytes())
    }

    /// Adds bytes to the new file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_bytes(&mut self, bytes: &[u8]) -> Result<(), Problem> {
        let written = self.file().and_then(|file| file.write_all(bytes));
        written.map_err(|error| unwritable(&self.named, &error))
    }

    /// Puts the new file in the place of its target.
    ///
    /// # Errors
    /// The target cannot be replaced.
    pub fn finish(mut self) -> Result<(), Problem> {
        let flushed = self.file().and_then(File::flush);
        let placed = flushed.and_then(|()| match &self.destination {
            Destination::Beside(new, _) => std::fs::rename(new, &self.target),
            Destination::Direct(_) | Destination::NewFile | Destination::Placed => Ok(()),
        });
        placed.map_err(|error| unwritable(&self.named, &error))?;
        self.destination = Destination::Placed;
        Ok(())
    }
}

impl Drop for Replacement {
    /// Removes a file that is not complete.
    fn drop(&mut self) {
        if let Destination::Beside(beside, _) = &self.destination {
            let _ = std::fs::remove_file(beside);
        }
    }
}

/// Replaces the content of a file, or creates the file.
///
/// # Errors
/// The file cannot be written; it then has its old content.
pub fn replace(path: &Path, text: &str) -> Result<(), Problem> {
    let mut file = Replacement::begin(path)?;
    file.write(text)?;
    file.finish()
}

/// The path with all symbolic links followed, also of a file that does not exist yet.
#[must_use]
pub fn target(path: &Path) -> PathBuf {
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or_else(|| Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        (Ok(_) | Err(_), _) => path.to_owned(),
    }
}

/// The stream that a path of the system names, for writing behind what it has; `None` for any other path.
#[cfg(unix)]
fn stream(path: &Path) -> Option<io::Result<File>> {
    use std::os::fd::AsFd;
    let number = match path.to_str()? {
        "/dev/stdout" => 1,
        "/dev/stderr" => 2,
        name => name.strip_prefix("/dev/fd/").or_else(|| name.strip_prefix("/proc/self/fd/"))?.parse::<u32>().ok()?,
    };
    // Opened by its name, a file would be written from its beginning.
    Some(match number {
        1 => io::stdout().as_fd().try_clone_to_owned().map(File::from),
        2 => io::stderr().as_fd().try_clone_to_owned().map(File::from),
        _ => OpenOptions::new().append(true).open(path),
    })
}

#[cfg(not(unix))]
fn stream(_: &Path) -> Option<io::Result<File>> {
    None
}

/// A new file in the folder of another one.
fn create_beside(target: &Path) -> io::Result<(PathBuf, File)> {
    loop {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let mut name = OsString::from(".");
        name.push(target.file_name().unwrap_or_default());
        name.push(format!(".{}-{number}.new", std::process::id()));
        let beside = target.with_file_name(name);
        match OpenOptions::new().write(true).create_new(true).open(&beside) {
            Ok(file) => return Ok((beside, file)),
            // An earlier process with the same number left it.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("opennck-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
    }

    /// `>>` of a shell: what the file had stays.
    #[cfg(unix)]
    #[test]
    fn a_stream_that_the_shell_opened_is_written_behind_what_it_has() {
        use std::os::fd::AsRawFd;
        let folder = folder("stream");
        let path = folder.join("a.txt");
        std::fs::write(&path, "old\n").unwrap();
        let opened = OpenOptions::new().append(true).open(&path).unwrap();
        replace(Path::new(&format!("/dev/fd/{}", opened.as_raw_fd())), "new\n").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old\nnew\n");
        assert_eq!(names(&folder), ["a.txt"]);
        assert!(replace(Path::new("/dev/fd/987654"), "x").is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_old_file_stays_until_the_new_one_is_complete() {
        let folder = folder("replaced");
        let path = folder.join("a.txt");
        replace(&path, "old").unwrap();
        let mut new = Replacement::begin(&path).unwrap();
        assert_eq!(names(&folder), ["a.txt"], "a signal during the run leaves no other file");
        new.write("half of the ne").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        drop(new);
        assert_eq!(
            (std::fs::read_to_string(&path).unwrap().as_str(), names(&folder)),
            ("old", vec!["a.txt".to_owned()])
        );
        replace(&path, "new").unwrap();
        assert_eq!(
            (std::fs::read_to_string(&path).unwrap().as_str(), names(&folder)),
            ("new", vec!["a.txt".to_owned()])
        );
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_devices_are_written_directly() {
        let folder = folder("links");
        let (path, link) = (folder.join("a.txt"), folder.join("link"));
        replace(&path, "old").unwrap();
        std::os::unix::fs::symlink("a.txt", &link).unwrap();
        replace(&link, "new").unwrap();
        assert!(link.is_symlink());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
        replace(Path::new("/dev/null"), "gone").unwrap();
        let problem = replace(&folder, "x").unwrap_err();
        assert!(problem.to_string().contains("cannot be written"), "{problem}");
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_a_file_that_cannot_be_written() {
        let problem = replace(Path::new("/dev/full"), "text").unwrap_err();
        assert!(problem.to_string().starts_with("/dev/full: cannot be written: "), "{problem}");
    }
}
