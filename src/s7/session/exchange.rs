//! A request and the answers to it.

use crate::s7::station::Station;
use crate::s7::wire::header::ErrorCode;
use crate::s7::wire::pdu::{Answers, Budget, Pdu};

/// The data that every answer needs.
pub(super) struct Exchange<'a> {
    pub(super) station: &'a mut dyn Station,
    pub(super) answers: &'a mut Answers,
    pub(super) reference: u16,
    pub(super) budget: Budget,
}

impl Exchange<'_> {
    /// Refuses a job.
    pub(super) fn refuse(&mut self, error: ErrorCode) {
        Pdu::refuse(self.answers, self.reference, self.budget, error);
    }
}
