//! Facts about one step.
