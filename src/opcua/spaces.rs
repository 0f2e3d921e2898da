//! The namespaces of the server and their indices.

/// The namespace of a SINUMERIK.
pub(super) const URI: &str = "SinumerikVarProvider";
/// Its index: most clients do not ask for it.
pub(super) const NAMESPACE: u16 = 2;
/// The namespace of OPC 40502, as its file has it: without a slash at the end.
pub(super) const CNC_URI: &str = "http://opcfoundation.org/UA/CNC";
/// Its index: the one after ours.
pub(super) const CNC: u16 = 3;
