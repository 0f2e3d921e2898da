//! Facts about machine data.
