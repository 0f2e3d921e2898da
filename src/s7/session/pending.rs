//! Answers that a client fetches in pieces: long answers of user data, and uploads of blocks.

/// The part that has not been sent yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub(super) payload: Vec<u8>,
    pub(super) sent: usize,
    /// Group, function and sequence of the answer; `None` when all is sent.
    pub(super) of: Option<[u8; 3]>,
}

/// The open uploads.
#[derive(Clone, Debug, Default)]
pub(super) struct Uploads {
    pub(super) open: Vec<Upload>,
    pub(super) last: u8,
}

#[derive(Clone, Debug)]
pub(super) struct Upload {
    pub(super) number: u8,
    pub(super) content: Vec<u8>,
    pub(super) sent: usize,
}

impl Uploads {
    pub(super) fn find(&mut self, number: u8) -> Option<&mut Upload> {
        self.open.iter_mut().find(|upload| upload.number == number)
    }
}
