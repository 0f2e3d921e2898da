//! Answers that a client fetches piece by piece: long answers of user data, and blocks that it uploads.

/// What has not been sent yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Parts {
    pub(super) payload: Vec<u8>,
    pub(super) sent: usize,
    /// Group, function and sequence of the answer; none when all is sent.
    pub(super) of: Option<[u8; 3]>,
}

/// The uploads that are open.
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
