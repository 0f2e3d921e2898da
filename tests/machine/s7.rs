//! A machine as an operator panel sees it: S7 requests in, a step, S7 answers out. No socket is needed for that.
#![cfg(feature = "s7")]

use opennck::machine::{Command as Queued, Machine};
use opennck::plc::program;
use opennck::s7::{Answers, Bridge, Command, Directory, Session, Settings};
use opennck::units::Position;

/// A machine with one client.
struct Window {
    machine: Machine,
    directory: Directory,
    session: Session,
}

impl Window {
    /// The worked example with everything enabled, and a client that has called the NCK and negotiated 480 bytes.
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
        let mut window = Self { machine, directory, session: Session::new(Settings::default()) };
        window.steps(500);
        window.send(&[3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 4, 0, 0xC2, 2, 13, 4]);
        window.job(&[0xF0, 0, 0, 1, 0, 1, 1, 0xE0], &[]);
        window
    }

    fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.machine.step();
        }
        self.machine.drain();
    }

    /// What a server does: a bridge over the state after a step, and what clients ask for into the queue of the next one.
    fn send(&mut self, bytes: &[u8]) -> Vec<u8> {
        let Self { machine, directory, session } = self;
        let mut answers = Answers::default();
        let mut bridge = Bridge::new(machine.memory(), machine.variables(), machine.names(), directory);
        let _ = session.receive(bytes, &mut bridge, &mut answers);
        for command in bridge.into_commands() {
            let Command::Write { location, value } = command else { panic!("only writes are asked for: {command:?}") };
            machine.queue(Queued::Write { location, value }).expect("a write is always taken");
        }
        answers.bytes().to_vec()
    }

    /// The answer to a job behind its header of 12 bytes.
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
    let mut window = Window::open();
    assert!(window.bit(11, 6, 2), "JOG is active");
    let before = window.position(1);
    window.set(31, 4, 7, true); // traversing key plus
    assert_eq!(window.position(1).to_bits(), before.to_bits(), "nothing acts before the edge of a step");
    assert!(!window.bit(31, 4, 7));
    window.steps(200);
    let x = window.machine.axis("X").expect("the example has an axis X");
    assert!(window.bit(31, 4, 7));
    assert!(window.bit(31, 64, 7), "travel command plus");
    let shown = window.position(1);
    assert_eq!(Position::from_user(shown), window.machine.variables().axes[x].position);
    assert!(shown > before + 0.1, "{before} to {shown}");
}

/// SIG-11 A bit of the NCK that somebody else overwrites has its value again at the next publication.
#[test]
fn a_bit_of_the_nck_that_a_client_overwrites_comes_back() {
    let mut window = Window::open();
    assert!(window.bit(31, 101, 6), "X is a leading axis");
    window.set(31, 101, 6, false);
    window.steps(1);
    assert!(window.bit(31, 101, 6));
    assert!(!window.bit(31, 101, 5), "and the grouping is not synchronized");
    window.set(31, 101, 5, true);
    window.steps(1);
    assert!(!window.bit(31, 101, 5));
}
