//! The program `opennck`.
fn main() -> std::process::ExitCode {
    opennck::cli::main(opennck::plc::Programs::ready())
}
