//! `opennck serve` as users call it: it prints its address, and ends with exit code 0 on a signal.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use rust7::{S7_AREA_DB, S7_AREA_MK, S7_WL_BYTE, S7Client};

use crate::processes::EndsWithTest;

fn serve(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
    command.arg("serve").args(arguments).current_dir(Path::new(env!("CARGO_MANIFEST_DIR")));
    command
}

/// A server on any free port, and the port.
struct Served {
    child: Child,
    _ends: EndsWithTest,
    head: Vec<String>,
    port: u16,
}

impl Served {
    fn start(arguments: &[&str]) -> Self {
        let mut command = serve(arguments);
        let command = command.args(["--s7", "127.0.0.1:0"]).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program was built");
        let ends = EndsWithTest::new(&child);
        let mut lines = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        let mut head = Vec::new();
        while !head.iter().any(|line: &String| line.contains("Ctrl-C")) {
            head.push(lines.next().expect("the banner ends with Ctrl-C").expect("text"));
        }
        let port = head.iter().find_map(|line| line.split_once("127.0.0.1:")?.1.split(':').next()?.parse().ok());
        Self { child, _ends: ends, head, port: port.expect("the output has the port") }
    }

    fn client(&self) -> S7Client {
        let mut client = S7Client::new();
        client.set_connection_port(self.port).expect("it is not connected yet");
        client.connect_rack_slot("127.0.0.1", 0, 2).expect("the server is there");
        client
    }

    /// Its output after a signal.
    fn end(self, signal: &str) -> Output {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args([signal, &id]).status().expect("there is a kill").success());
        self.child.wait_with_output().expect("it ends")
    }
}

#[test]
#[cfg(unix)]
fn it_serves_until_it_is_stopped() {
    for signal in ["-INT", "-TERM"] {
        let served = Served::start(&["g1_example", "--plc", "enable_all", "--plc-image", "recipes", "--speed", "2"]);
        assert!(served.head[0].contains("axes X, Y, XF") && served.head[0].contains("enable_all"), "{:?}", served.head);
        let mut client = served.client();
        while !client.read_bit(S7_AREA_DB, 31, 101, 6).unwrap() {} // X is the leading axis, after the start-up of the control
        let output = served.end(signal);
        let log = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{log}");
        assert!(log.contains(" connected") && log.contains("the server stops"), "{log}");
    }
}

#[test]
fn an_unusable_argument_ends_it_with_cause_and_remedy() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    let metrics = format!("--metrics={taken}");
    for (arguments, said) in [
        (["g1_example", "--s7", &taken], ["the port is in use", "choose another port"]),
        (["g1_example", "--plc", "enable_al"], ["`enable_al`", "enable_all"]),
        (["g1_exampel", "--s7", "127.0.0.1:0"], ["g1_exampel", "g1_example"]),
        (["g1_example", "--plc-image", "no_such"], ["plc_images/no_such.toml", ".toml"]),
        (["g1_example", "--speed", "0"], ["0.001 to 1000", "--speed"]),
        (["g1_example", "--allow", "10.0.0.0/33"], ["10.0.0.0/33", "192.168.0.0/24"]),
        (["g1_example", "--profile", "840d"], ["840d", "828d"]),
        (["g1_example", "--s7-fault", "drop=2"], ["drop", "1/100"]),
        (["g1_example", "--s7-fault", "code=8104"], ["error= together with code=", "code=8104: add error=1%"]),
        (["g1_example", "--s7=127.0.0.1:0", "--pcap=no_such/a.pcap"], ["no_such/a.pcap", "an existing folder"]),
        (["g1_example", "--protect", "DB99"], ["--protect DB99", "DB1000.DBB0..99"]),
        (["g1_example", "--password", "too long for it"], ["--password", "1 to 8 characters"]),
        (["g1_example", "--protection-level=3", "--read-only"], ["--protection-level 3", "OPENNCK_S7_PASSWORD"]),
        (["g1_example", "--identity", "no_such.toml"], ["no_such.toml", "check the path"]),
        (["g1_example", "--pdu", "100"], ["100", "240..=960"]),
        (["g1_example", "--idle", "10"], ["10", "500ms, 30s or 10min"]),
        (["g1_example", "--s7=127.0.0.1:0", &metrics], ["--metrics", "the port is in use"]),
    ] {
        let output = serve(&arguments).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(said.iter().all(|said| error.contains(said)), "{arguments:?}: {error}");
    }
}

#[test]
#[cfg(unix)]
fn the_log_shows_writes_and_refusals() {
    let served = Served::start(&["g1_example", "--log-writes", "--protect", "MB10..19", "--metrics", "0"]);
    assert!(served.head.iter().any(|line| line.contains("metrics on http://127.0.0.1:")), "{:?}", served.head);
    let mut client = served.client();
    client.write_area(S7_AREA_MK, 0, 0, S7_WL_BYTE, &[0xAB, 0xCD]).unwrap();
    assert!(client.write_area(S7_AREA_MK, 0, 8, S7_WL_BYTE, &[1; 4]).is_err());
    assert!(client.read_db(99, 4, &mut [0; 10]).is_err());
    let log = String::from_utf8(served.end("-INT").stderr).unwrap();
    for line in [
        "wrote MB0, 2 bytes = AB CD",
        "refused: write MB8, 4 bytes: 03, access is not allowed",
        "refused: read DB99.DBB4, 10 bytes: 0A, the object does not exist",
    ] {
        assert!(log.lines().any(|found| found.contains("127.0.0.1:") && found.ends_with(line)), "{line}: {log}");
    }
}

#[test]
#[cfg(unix)]
fn an_open_server_prints_a_warning() {
    let open = ["g1_example", "--s7", "0.0.0.0:0"];
    for (more, is_warned) in [(&[][..], true), (&["--read-only"], false), (&["--allow", "127.0.0.1"], false)] {
        let served = Served::start(&[&open[..], more].concat());
        let log = String::from_utf8(served.end("-INT").stderr).unwrap();
        assert_eq!(log.contains("anyone who can reach 0.0.0.0:"), is_warned, "{more:?}: {log}");
    }
}

/// The password does not appear in the process list or in the help.
#[test]
#[cfg(unix)]
fn a_password_comes_from_the_environment() {
    let output = serve(&["--help"]).env("OPENNCK_S7_PASSWORD", "hidden").output().unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    assert!(help.contains("OPENNCK_S7_PASSWORD") && !help.contains("hidden"), "{help}");
    let output = serve(&["g1_example"]).env("OPENNCK_S7_PASSWORD", "too long for it").output().unwrap();
    assert!(String::from_utf8(output.stderr).unwrap().contains("1 to 8 characters"));
}

/// The requests of `opennck s7` leave no refusal in the log of a control.
#[test]
#[cfg(unix)]
fn the_client_of_this_project_sends_no_request_that_is_refused() {
    let served = Served::start(&["g1_example"]);
    let host = format!("127.0.0.1:{}", served.port);
    let s7 = |command, more: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_opennck"));
        program.args(["s7", command, &host]).args(more).output().expect("it was built")
    };
    // XF, axis 3, is not a standard name: it is read from the NCK.
    let read = String::from_utf8(s7("read", &["XF.feed_override"]).stdout).unwrap();
    assert!(read.contains("DB33.DBB0") && read.contains("XF.feed_override"), "{read}");
    assert_eq!(s7("info", &[]).status.code(), Some(0));
    let log = String::from_utf8(served.end("-INT").stderr).unwrap();
    assert!(log.contains(" connected") && !log.contains("refused"), "{log}");
}

/// A client that called a missing slot is not logged as one that disconnected.
#[test]
#[cfg(unix)]
fn the_log_distinguishes_a_refused_slot_from_another_protocol() {
    let served = Served::start(&["g1_example", "--strict-slots"]);
    let call = |bytes: &[u8]| {
        let mut stream = TcpStream::connect(("127.0.0.1", served.port)).unwrap();
        stream.write_all(bytes).unwrap();
        let _ = stream.read_to_end(&mut Vec::new()); // until the server ends it
    };
    let connect = [3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, 0x09];
    call(&connect);
    call(b"GET / HTTP/1.1");
    let log = String::from_utf8(served.end("-INT").stderr).unwrap();
    for line in
        ["rejected: no module at TSAP 0109 (rack 0, slot 9)", "closed: the client does not use S7 communication"]
    {
        assert!(log.lines().any(|found| found.ends_with(line)), "{line}: {log}");
    }
}

#[test]
#[cfg(unix)]
fn the_banner_shows_the_machine_and_the_terms() {
    let served = Served::start(&["g1_example", "--profile=828d", "--password=abc", "--pdu=480", "--protect=MB0"]);
    let head = served.head.join("\n");
    for said in
        ["profile 828d, no PLC image", "except --protect, protection level 2 with a password, PDU up to 480 bytes"]
    {
        assert!(head.contains(said), "{said}: {head}");
    }
    served.end("-INT");
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("banner.image");
    let image = ["g1_example", "--plc-image", "recipes", "--image", file.to_str().unwrap(), "--lock-step"];
    let served = Served::start(&image);
    for said in ["profile 840d_sl, PLC image ", "recipes.toml, image file ", "banner.image (lock-step, time-out 1s)"] {
        assert!(served.head[1].contains(said), "{said}: {:?}", served.head);
    }
    served.end("-INT");
}
