//! `opennck serve` as its users call it: it says where it can be reached, and ends with 0 when it is asked to.
#![cfg(all(feature = "cli", feature = "s7"))]

use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use rust7::{S7_AREA_DB, S7Client};

fn serve(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
    command.arg("serve").args(arguments).current_dir(Path::new(env!("CARGO_MANIFEST_DIR")));
    command
}

/// A server on any free port, and the port.
struct Served {
    child: Child,
    head: Vec<String>,
    port: u16,
}

impl Served {
    fn start(arguments: &[&str]) -> Self {
        let mut command = serve(arguments);
        let command = command.args(["--s7", "127.0.0.1:0"]).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program was built");
        let mut lines = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        let mut head = Vec::new();
        while !head.iter().any(|line: &String| line.contains("Ctrl-C")) {
            head.push(lines.next().expect("it says that Ctrl-C ends").expect("text"));
        }
        let port = head.iter().find_map(|line| line.split_once("127.0.0.1:")?.1.split(':').next()?.parse().ok());
        Self { child, head, port: port.expect("it says its port") }
    }

    fn client(&self) -> S7Client {
        let mut client = S7Client::new();
        client.set_connection_port(self.port).expect("it is not connected yet");
        client.connect_rack_slot("127.0.0.1", 0, 2).expect("the server is there");
        client
    }

    /// What it says after a signal.
    fn end(self, signal: &str) -> Output {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args([signal, &id]).status().expect("there is a kill").success());
        self.child.wait_with_output().expect("it ends")
    }
}

#[test]
#[cfg(unix)]
fn it_serves_until_it_is_asked_to_end() {
    for signal in ["-INT", "-TERM"] {
        let served = Served::start(&["g1_example", "--plc", "enable_all", "--plc-image", "recipes", "--speed", "2"]);
        assert!(served.head[0].contains("axes X, Y, XF") && served.head[0].contains("enable_all"), "{:?}", served.head);
        let mut client = served.client();
        while !client.read_bit(S7_AREA_DB, 31, 101, 6).unwrap() {} // X is the leading axis, when the control has run up
        let output = served.end(signal);
        let log = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{log}");
        assert!(log.contains("has come") && log.contains("the server ends"), "{log}");
    }
}

#[test]
fn a_closed_door_ends_it_with_cause_and_cure() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    for (arguments, said) in [
        (["g1_example", "--s7", &taken], ["one in use", "choose another port"]),
        (["g1_example", "--plc", "enable_al"], ["`enable_al`", "enable_all"]),
        (["g1_exampel", "--s7", "127.0.0.1:0"], ["g1_exampel", "g1_example"]),
        (["g1_example", "--plc-image", "no_such"], ["plc_images/no_such.toml", ".toml"]),
        (["g1_example", "--speed", "0"], ["0.001 to 1000", "--speed"]),
        (["g1_example", "--allow", "10.0.0.0/33"], ["10.0.0.0/33", "192.168.0.0/24"]),
    ] {
        let output = serve(&arguments).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(said.iter().all(|said| error.contains(said)), "{arguments:?}: {error}");
    }
}
