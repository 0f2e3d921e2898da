//! State is plain data: save, restore and copy in the middle of a timer.

use proptest::prelude::proptest;

use super::{Plc, SECOND};
use crate::plc::step7::engine::{Cpu, CpuOptions, CpuState, OwnMemory};

const PROGRAM: &str = "A M 0.0; L S5T#300MS; SD T 1; A T 1; = M 1.0; A M 0.0; FP M 2.0; CU C 1; L MW 4; + 1; T MW 4; \
    L LW 30; + 3; T LW 30; T MW 6; L T 1; T MW 8;";

fn run(plc: &mut Plc, inputs: &[bool]) -> Vec<u8> {
    let mut course = Vec::new();
    for &input in inputs {
        plc.set_bit(0, 0, input).after(SECOND / 20);
        course.extend_from_slice(&plc.memory.flags[..10]);
    }
    course
}

proptest! {
    #[test]
    fn a_saved_program_goes_on_as_the_original(
        before in proptest::collection::vec(proptest::bool::ANY, 0..12),
        after in proptest::collection::vec(proptest::bool::ANY, 0..12),
    ) {
        let mut original = Plc::of_statements(PROGRAM);
        run(&mut original, &before);
        let mut copy = original.clone();
        let saved = postcard::to_stdvec(&(original.cpu.state(), &original.memory)).unwrap();
        let (state, memory): (CpuState, OwnMemory) = postcard::from_bytes(&saved).unwrap();
        let mut restored = Plc::of_statements(PROGRAM);
        assert!(restored.cpu.restore(state));
        restored.memory = memory;
        restored.now = original.now;
        let course = run(&mut original, &after);
        assert_eq!(run(&mut copy, &after), course);
        assert_eq!(run(&mut restored, &after), course);
        assert_eq!(restored.cpu.state(), original.cpu.state());
    }
}

#[test]
fn a_state_of_another_program_is_refused() {
    let other = Plc::new("ORGANIZATION_BLOCK OB 1\nBEGIN\nA T 5;\nEND_ORGANIZATION_BLOCK\n");
    let mut plc = Plc::of_statements(PROGRAM);
    assert!(!plc.cpu.restore(other.cpu.state().clone()));
    let options = CpuOptions { local_data: 2048, ..CpuOptions::default() };
    let larger = Cpu::new(super::program(&super::ob1(PROGRAM)), options);
    assert!(!plc.cpu.restore(larger.state().clone()));
}
