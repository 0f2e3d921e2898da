//! The certificate of the server and its private key, and the clients that it trusts.
//!
//! | file | content |
//! |---|---|
//! | `own/cert.der` | the certificate of the server, made at the first start |
//! | `private/private.pem` | its private key; only its owner can read it |
//! | `trusted/` | the certificates of clients that may connect |
//! | `rejected/` | the certificates of clients that were refused: move one into `trusted/` to admit it |

use std::fs::{self, DirBuilder};
use std::io;
use std::path::{Path, PathBuf};

use opcua::crypto::{CertificateStore, X509Data};

use crate::source::Problem;

/// How long the certificate is valid.
const DAYS: u32 = 3650;

/// The certificate of the server, below a folder.
pub(super) fn own(folder: &Path) -> PathBuf {
    folder.join("own").join("cert.der")
}

/// Its private key.
pub(super) fn key(folder: &Path) -> PathBuf {
    folder.join("private").join("private.pem")
}

/// Makes the certificate of the server and its private key, unless both are there.
pub(super) fn prepare(folder: &Path, application: &str, address: &str) -> Result<(), Problem> {
    let cannot = |error: &dyn std::fmt::Display| {
        Problem::new(
            format!("--opcua-pki {}: cannot make the certificate: {error}", folder.display()),
            "choose a folder that you may write",
        )
    };
    for name in ["own", "trusted", "rejected"] {
        fs::create_dir_all(folder.join(name)).map_err(|error| cannot(&error))?;
    }
    let (own, key) = (own(folder), key(folder));
    private_folder(&folder.join("private")).map_err(|error| cannot(&error))?;
    if !own.exists() || !key.exists() {
        let names = Some(vec![address.to_owned()]);
        let data = X509Data {
            key_size: 2048,
            common_name: "OpenNCK".to_owned(),
            organization: "OpenNCK".to_owned(),
            organizational_unit: "OpenNCK".to_owned(),
            country: "XX".to_owned(),
            state: "none".to_owned(),
            alt_host_names: X509Data::alt_host_names(application, names, true, true, false),
            certificate_duration_days: DAYS,
        };
        CertificateStore::create_certificate_and_key(&data, true, &own, &key).map_err(|error| cannot(&error))?;
    }
    // The library writes the key so that others can read it; nobody else could open its folder in the meantime.
    only_for_its_owner(&key).map_err(|error| cannot(&error))
}

#[cfg(unix)]
fn private_folder(folder: &Path) -> io::Result<()> {
    use std::os::unix::fs::{DirBuilderExt, PermissionsExt};
    match DirBuilder::new().mode(0o700).create(folder) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            fs::set_permissions(folder, fs::Permissions::from_mode(0o700))
        }
        made => made,
    }
}

#[cfg(unix)]
fn only_for_its_owner(file: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(file, fs::Permissions::from_mode(0o600))
}

#[cfg(not(unix))]
fn private_folder(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).create(folder)
}

#[cfg(not(unix))]
fn only_for_its_owner(_: &Path) -> io::Result<()> {
    Ok(())
}

/// The certificates that were refused so far.
pub(super) fn rejected(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.join("rejected")).into_iter().flatten();
    let mut files: Vec<_> = entries.filter_map(|entry| entry.ok().map(|entry| entry.path())).collect();
    files.sort();
    files
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn only_its_owner_can_read_the_private_key() {
        let folder = std::env::temp_dir().join(format!("opennck-pki-{}", std::process::id()));
        prepare(&folder, "urn:opennck", "127.0.0.1").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!((mode(&key(&folder)), mode(&folder.join("private"))), (0o600, 0o700));
        let before = fs::read(own(&folder)).unwrap();
        // The certificate that clients trust stays the same, and a key that others could read becomes private.
        fs::set_permissions(key(&folder), fs::Permissions::from_mode(0o644)).unwrap();
        prepare(&folder, "urn:opennck", "127.0.0.1").unwrap();
        assert_eq!((mode(&key(&folder)), fs::read(own(&folder)).unwrap() == before), (0o600, true));
        assert_eq!(rejected(&folder), Vec::<PathBuf>::new());
        fs::remove_dir_all(&folder).unwrap();
    }
}
