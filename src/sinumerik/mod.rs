//! The control of the SINUMERIK manuals: its machine data, and what it does with them.

pub mod machine_data;
