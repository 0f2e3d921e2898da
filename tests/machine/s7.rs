//! Tests of a machine as an operator panel sees it: S7 requests in, a step, S7 answers out. The tests need no socket.
#![cfg(feature = "s7")]

use opennck::machine::{Command as Queued, Machine};
use opennck::plc::program;
use opennck::s7::{Answers, Bridge, Command, Directory, Session, Settings};
use opennck::units::Position;

/// A machine with one client.
struct Panel {
    machine: Machine,
    directory: Directory,
    session: Session,
}

impl Panel {
    /// Opens the worked example with all enables, and a client that is connected to the NCK with a PDU of 480 bytes.
    fn open() -> Self {
        let mut machine = Machine::open("g1_example").expect("it is built in");
        let plc = program("everything_on", (), |(), io| {
            for axis in io.axes() {
                let signals = io.to_nck.axis(axis);
                signals.set_position_measuring_system_1(true);
                signals.set_controller_enable(true);
                signals.set_pulse_enable(true);
            }
        });
        machine.load_program(plc.boxed());
        let directory = Directory::of(machine.memory(), machine.names().profile);
        let mut panel = Self { machine, directory, session: Session::new(Settings::default()) };
        panel.steps(500);
        panel.send(&[3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 4, 0, 0xC2, 2, 13, 4]);
        panel.job(&[0xF0, 0, 0, 1, 0, 1, 1, 0xE0], &[]);
        panel
    }

    fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.machine.step();
        }
        self.machine.drain();
    }

    /// Does the work of a server: a bridge over the state after a step; requests of clients become commands for the next step.
    fn send(&mut self, bytes: &[u8]) -> Vec<u8> {
        let Self { machine, directory, session } = self;
        let mut answers = Answers::default();
        let mut bridge = Bridge::new(machine.memory(), machine.variables(), machine.names(), directory);
        let _ = session.receive(bytes, &mut bridge, &mut answers);
        for command in bridge.into_commands() {
            let Command::Write { location, value } = command else { panic!("only writes are expected: {command:?}") };
            machine.queue(Queued::Write { location, value }).expect("a write is always accepted");
        }
        answers.bytes().to_vec()
    }

    /// The answer to a job, after its header of 12 bytes.
    fn job(&mut self, parameter: &[u8], data: &[u8]) -> Vec<u8> {
        let length = |bytes: usize| u16::try_from(bytes).expect("short").to_be_bytes();
        let [total, p, d] = [17 + parameter.len() + data.len(), parameter.len(), data.len()].map(length);
        let head = [3, 0, total[0], total[1], 2, 0xF0, 0x80, 0x32, 1, 0, 0, 0, 1, p[0], p[1], d[0], d[1]];
        let answer = self.send(&[&head, parameter, data].concat());
        answer[19..].to_vec()
    }

    /// One bit of a data block.
    fn bit(&mut self, db: u8, byte: u16, bit: u8) -> bool {
        let item = item(db, byte, bit);
        let answer = self.job(&[&[4, 1][..], &item].concat(), &[]);
        assert_eq!(answer[2..6], [0xFF, 3, 0, 1]);
        answer[6] == 1
    }

    fn set(&mut self, db: u8, byte: u16, bit: u8, value: bool) {
        let item = item(db, byte, bit);
        let answer = self.job(&[&[5, 1][..], &item].concat(), &[0, 3, 0, 1, value.into()]);
        assert_eq!(answer, [5, 1, 0xFF]);
    }

    /// C/MachineAxis/actToolBasePos of an axis in millimetres.
    fn position(&mut self, axis: u8) -> f64 {
        let answer = self.job(&[4, 1, 0x12, 8, 0x82, 0x41, 0, 2, 0, axis, 0x74, 1], &[]);
        assert_eq!(answer[2..6], [0xFF, 9, 0, 8]);
        f64::from_le_bytes(answer[6..14].try_into().expect("eight bytes"))
    }
}

fn item(db: u8, byte: u16, bit: u8) -> [u8; 12] {
    let [high, low] = (byte * 8 + u16::from(bit)).to_be_bytes();
    [0x12, 10, 0x10, 1, 0, 1, 0, db, 0x84, 0, high, low]
}

#[test]
fn a_key_that_is_pressed_over_s7_moves_the_axis_and_its_position_is_read_back() {
    let mut panel = Panel::open();
    assert!(panel.bit(11, 6, 2), "JOG is active");
    let before = panel.position(1);
    panel.set(31, 4, 7, true); // traversing key plus
    assert_eq!(panel.position(1).to_bits(), before.to_bits(), "a write has no effect before the next step");
    assert!(!panel.bit(31, 4, 7));
    panel.steps(200);
    let x = panel.machine.axis("X").expect("the example has an axis X");
    assert!(panel.bit(31, 4, 7));
    assert!(panel.bit(31, 64, 7), "travel command plus");
    let shown = panel.position(1);
    assert_eq!(Position::from_user(shown), panel.machine.variables().axes[x].position);
    assert!(shown > before + 0.1, "{before} to {shown}");
}

/// SIG-11: a bit of the NCK that a client overwrites has its value again after the next publication.
#[test]
fn a_bit_of_the_nck_that_a_client_overwrites_is_restored() {
    let mut panel = Panel::open();
    assert!(panel.bit(31, 101, 6), "X is a leading axis");
    panel.set(31, 101, 6, false);
    panel.steps(1);
    assert!(panel.bit(31, 101, 6));
    assert!(!panel.bit(31, 101, 5), "the grouping is not synchronized");
    panel.set(31, 101, 5, true);
    panel.steps(1);
    assert!(!panel.bit(31, 101, 5));
}
