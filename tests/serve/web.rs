//! The live page over plain sockets: its files, its commands, its events, what it refuses, and going back in time.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::disallowed_methods, reason = "a live machine is watched in real time")]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use opennck::live::{Live, LiveOptions, Opening, Speed};
use opennck::plc::Programs;
use opennck::scenario::Scenario;
use opennck::web::{WebOptions, WebServer};
use serde_json::{Value, json};

/// A machine and its page, which ends first.
pub(super) struct Page {
    server: WebServer,
    live: Live,
}

impl Page {
    pub(super) fn open(change: impl FnOnce(&mut WebOptions)) -> Self {
        Self::open_machine("g1_example", Some("enable_all"), change)
    }

    pub(super) fn open_machine(machine: &str, plc: Option<&str>, change: impl FnOnce(&mut WebOptions)) -> Self {
        let opening = Opening { machine: Some(Path::new(machine)), plc, ..Opening::default() };
        let opened = opening.open(&Programs::ready(), &mut |_| {}).unwrap();
        let mut options = WebOptions::new("127.0.0.1:0", &opened);
        change(&mut options);
        let transcript = opened.transcript(Path::new("session.toml")).ok();
        let live = LiveOptions { keeps_history: true, transcript, ..LiveOptions::default() };
        let live = Live::start_with(opened.machine, Speed::default(), live);
        Self { server: WebServer::open(&live, options).unwrap(), live }
    }

    fn address(&self) -> SocketAddr {
        SocketAddr::new([127, 0, 0, 1].into(), self.server.addresses()[0].port())
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(self.address()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        stream
    }

    /// The answer to a request: status, headers, body.
    pub(super) fn ask(&self, method: &str, path: &str, headers: &str, body: &str) -> (u16, String, String) {
        let mut stream = self.connect();
        let host = if headers.contains("Host:") { String::new() } else { format!("Host: {}\r\n", self.address()) };
        let length = body.len();
        let head =
            format!("{method} {path} HTTP/1.1\r\n{host}{headers}Connection: close\r\nContent-Length: {length}\r\n");
        stream.write_all(format!("{head}\r\n{body}").as_bytes()).unwrap();
        let mut answer = String::new();
        let _ = stream.read_to_string(&mut answer);
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
        (status, head.to_owned(), body.to_owned())
    }

    pub(super) fn get(&self, path: &str) -> String {
        let (status, head, body) = self.ask("GET", path, "", "");
        assert_eq!(status, 200, "{path}: {head}");
        body
    }

    fn state(&self) -> Value {
        serde_json::from_str(&self.get("/api/state")).unwrap()
    }

    pub(super) fn post(&self, body: &Value, headers: &str) -> (u16, Value) {
        let headers = format!("Content-Type: application/json\r\n{headers}");
        let (status, _, body) = self.ask("POST", "/api/command", &headers, &body.to_string());
        (status, serde_json::from_str(&body).unwrap_or_default())
    }

    #[track_caller]
    pub(super) fn command(&self, body: &Value) -> u64 {
        let (status, answer) = self.post(body, "");
        assert_eq!(status, 200, "{body}: {answer}");
        answer["cycle"].as_u64().unwrap()
    }

    fn cycle(&self) -> u64 {
        self.live.with(|machine| machine.cycle())
    }

    /// Pauses, and takes single steps up to a cycle.
    pub(super) fn step_to(&self, cycle: u64) {
        self.command(&json!({"pause": true}));
        let now = self.cycle();
        if cycle > now {
            self.command(&json!({"step": cycle - now}));
        }
        assert_eq!(self.cycle(), cycle, "single steps are answered when they are taken");
    }
}

#[track_caller]
fn until(mut is_so: impl FnMut() -> bool) {
    let begin = Instant::now();
    while !is_so() {
        assert!(begin.elapsed() < Duration::from_secs(20), "it does not become true");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The stream of events of a client.
pub(super) struct Events(BufReader<TcpStream>);

impl Events {
    pub(super) fn open(page: &Page) -> Self {
        let mut stream = page.connect();
        stream.write_all(format!("GET /events HTTP/1.1\r\nHost: {}\r\n\r\n", page.address()).as_bytes()).unwrap();
        Self(BufReader::new(stream))
    }

    /// The next event: its name and its data.
    pub(super) fn next(&mut self) -> (String, Value) {
        let mut name = String::new();
        loop {
            let mut line = String::new();
            assert_ne!(self.0.read_line(&mut line).unwrap(), 0, "the stream ended");
            if let Some(event) = line.strip_prefix("event: ") {
                event.trim_end().clone_into(&mut name);
            }
            if let Some(data) = line.strip_prefix("data: ") {
                return (name, serde_json::from_str(data).unwrap());
            }
        }
    }
}

#[test]
fn the_page_is_inside_the_program_and_loads_nothing_else() {
    let page = Page::open(|_| {});
    let index = page.get("/");
    assert!(index.contains("<html lang=\"en\">") && !index.contains("<script>"), "{index}");
    let mut files: Vec<_> = std::fs::read_dir("src/web/page").unwrap().map(|file| file.unwrap().path()).collect();
    files.sort();
    for file in files {
        let name = file.file_name().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(&file).unwrap();
        for line in text.lines().filter(|line| line.contains("http://") || line.contains("https://")) {
            assert!(line.contains("http://www.w3.org/2000/svg"), "{name} names another server: {line}");
        }
        for other in ["innerHTML", "outerHTML", "insertAdjacentHTML", "document.write"] {
            assert!(!text.contains(other), "{name}: a text must become a text node, not {other}");
        }
        let path =
            if name.starts_with("favicon") || name.starts_with("index") { continue } else { format!("/page/{name}") };
        let (status, head, body) = page.ask("GET", &path, "", "");
        assert_eq!((status, body == text), (200, true), "{path}: is it in FILES of routes.rs?");
        for header in [
            "content-security-policy: default-src 'none'; ",
            "x-content-type-options: nosniff",
            "cache-control: no-store",
        ] {
            assert!(head.contains(header), "{path}: {header} is missing in {head}");
        }
    }
    assert_eq!(page.ask("GET", "/page/../mod.rs", "", "").0, 404);
}

#[test]
fn requests_that_do_not_come_from_the_page_are_refused() {
    let page = Page::open(|options| options.hosts.push("panel.example".to_owned()));
    let port = page.address().port();
    let json = "Content-Type: application/json\r\n";
    let body = json!({"set": {"M0.0": 1}}).to_string();
    for (method, path, headers, expected) in [
        ("GET", "/", format!("Host: evil.example:{port}\r\n"), 421),
        ("GET", "/", format!("Host: 127.0.0.1:{}\r\n", port.wrapping_add(1)), 421),
        ("GET", "/", format!("Host: localhost:{port}\r\n"), 200),
        ("GET", "/", format!("Host: [::1]:{port}\r\n"), 200),
        ("GET", "/", format!("Host: panel.example:{port}\r\n"), 200),
        ("GET", "/", "Sec-Fetch-Site: cross-site\r\n".to_owned(), 200),
        ("GET", "/events", "Sec-Fetch-Site: cross-site\r\n".to_owned(), 403),
        ("GET", "/api/state", "Origin: http://evil.example\r\n".to_owned(), 403),
        ("POST", "/api/command", format!("{json}Host: evil.example:{port}\r\n"), 421),
        ("POST", "/api/command", format!("{json}Origin: http://evil.example\r\n"), 403),
        ("POST", "/api/command", format!("{json}Origin: null\r\n"), 403),
        ("POST", "/api/command", format!("{json}Origin: http://127.0.0.1:{}\r\n", port.wrapping_add(1)), 403),
        ("POST", "/api/command", format!("{json}Origin: http://localhost:{port}\r\n"), 403),
        ("POST", "/api/command", format!("{json}Sec-Fetch-Site: same-site\r\n"), 403),
        ("POST", "/api/command", "Content-Type: application/x-www-form-urlencoded\r\n".to_owned(), 403),
        ("POST", "/api/command", "Content-Type: text/plain\r\n".to_owned(), 403),
        (
            "POST",
            "/api/command",
            format!("{json}Origin: http://127.0.0.1:{port}\r\nSec-Fetch-Site: same-origin\r\n"),
            200,
        ),
        ("POST", "/api/command", json.to_owned(), 200),
        ("PUT", "/api/command", json.to_owned(), 405),
    ] {
        let (status, head, _) = page.ask(method, path, &headers, if method == "GET" { "" } else { &body });
        assert_eq!(status, expected, "{method} {path} {headers}: {head}");
        assert!(head.contains("content-security-policy: "), "{head}");
    }
}

#[test]
fn a_command_acts_in_the_cycle_of_its_answer() {
    let page = Page::open(|_| {});
    page.step_to(1000);
    let cycle = page.command(&json!({"set": {"M10.0": 1, "X.feed_override": "50%"}}));
    assert_eq!(cycle, 1001);
    // Also while the machine runs as fast as it can: steps and cycles are the same until it goes back.
    let fast = Page::open(|_| {});
    fast.command(&json!({"speed": 1000}));
    for _ in 0..20 {
        let (_, answer) = fast.post(&json!({"set": {"M10.0": 1}}), "");
        assert_eq!(answer["cycle"], answer["step"], "{answer}");
    }
    assert_eq!(page.live.with(|machine| (machine.cycle(), machine.memory().flags[10])), (1000, 0));
    page.step_to(1001);
    assert_eq!(page.live.with(|machine| machine.memory().flags[10]), 1);
    for (body, said) in [
        (json!({"set": {"X.traversing_kee_plus": 1}}), "X.traversing_key_plus"),
        (json!({"set": {"X.referenced_synchronized_1": 1}}), "NCK"),
        (json!({"sett": {"M0.0": 1}}), "`set`"),
        (json!({"wait": "time > 1"}), "acts at once"),
        // A client must not read the files of this computer.
        (json!({"program": "Cargo.toml"}), "acts at once"),
        (json!({"include": "Cargo.toml"}), "acts at once"),
        (json!({"set": {"M0.0": 1}, "cancel": true}), "one verb"),
        (json!({"fault": {"axis": "X", "kind": "blok"}}), "block"),
        (json!({"speed": 0}), "0.001 to 1000"),
        (json!({"step": -1}), "a number of cycles"),
        (json!({"go_back": 100_000_000}), "cycle"),
        (json!([]), "one verb"),
        (json!(null), "null"),
    ] {
        let (status, answer) = page.post(&body, "");
        assert_eq!(status, 400, "{body}: {answer}");
        assert!(answer.to_string().contains(said), "{body}: {answer}");
    }
    let (status, ..) = page.ask("POST", "/api/command", "Content-Type: application/json\r\n", "{\"set\": ");
    assert_eq!(status, 400);
    let (status, ..) = page.ask("POST", "/api/command", "Content-Type: application/json\r\n", &"x".repeat(70_000));
    assert_eq!(status, 413);
    assert_eq!(page.cycle(), 1001, "nothing of it took a step");
}

#[test]
fn rights_are_those_of_s7() {
    let page = Page::open(|options| options.is_read_only = true);
    for body in [json!({"set": {"M0.0": 1}}), json!({"pause": true}), json!({"go_back": 1})] {
        assert_eq!(page.post(&body, "").0, 403, "{body}");
    }
    assert!(page.get("/api/catalogue").contains("\"read_only\":true"));
    let protects = |_: &opennck::machine::Machine, command: &opennck::machine::Command| {
        command.location().is_some_and(|location| location.offset == 7).then(|| "protected".to_owned())
    };
    let page = Page::open(|options| options.protects = Arc::new(protects));
    assert_eq!(page.post(&json!({"set": {"M7.0": 1}}), "").0, 403);
    assert_eq!(page.post(&json!({"set": {"M8.0": 1}}), "").0, 200);
}

#[test]
fn a_writer_from_another_computer_needs_the_token() {
    let page = Page::open(|options| options.address = "0.0.0.0:0".to_owned());
    let token = page.server.token().expect("it is open to the network").to_owned();
    let body = json!({"set": {"M0.0": 1}});
    page.get("/api/state");
    assert_eq!(page.post(&body, "").0, 403);
    assert_eq!(page.post(&body, &format!("Authorization: Bearer {token}\r\n")).0, 200);
    let exchange = |token: &str| {
        let body = json!({"token": token}).to_string();
        page.ask("POST", "/api/token", "Content-Type: application/json\r\n", &body)
    };
    assert_eq!(exchange("0").0, 403);
    let (status, head, _) = exchange(&token);
    assert_eq!(status, 204);
    let cookie = head.lines().find_map(|line| line.strip_prefix("set-cookie: ")).unwrap();
    assert!(cookie.contains("HttpOnly; SameSite=Strict"), "{cookie}");
    assert_eq!(page.post(&body, &format!("Cookie: {}\r\n", cookie.split(';').next().unwrap())).0, 200);
}

/// M0.0 is 1 for one cycle of 2 ms.
#[test]
fn events_carry_every_edge() {
    let page = Page::open(|_| {});
    page.step_to(500);
    let mut events = Events::open(&page);
    let (name, snapshot) = events.next();
    assert_eq!((name.as_str(), &snapshot["now"]["cycle"]), ("snapshot", &json!(500)));
    assert_eq!(snapshot["now"]["axes"].as_array().unwrap().len(), 3);
    for value in [1, 0] {
        page.command(&json!({"set": {"X.traversing_key_plus": value}}));
        page.command(&json!({"step": 1}));
    }
    let signals: Value = serde_json::from_str(&page.get("/api/catalogue")).unwrap();
    let index = signals["signals"].as_array().unwrap().iter().position(|row| row["symbol"] == "X.traversing_key_plus");
    let mut found = Vec::new();
    for _ in 0..20 {
        // On a busy computer the first steps of the machine come with these ones, as a new snapshot.
        let (name, told) = events.next();
        let edges = if name == "snapshot" { &told["recent"] } else { &told["edges"] };
        found.extend(edges.as_array().into_iter().flatten().filter(|edge| edge["i"] == json!(index)).cloned());
        if found.len() >= 2 {
            break;
        }
    }
    let expected =
        [(1.002, 1.0), (1.004, 0.0)].map(|(time, value)| json!({"t": time, "i": index, "v": value, "by": "outside"}));
    assert_eq!(found, expected);
    assert_eq!(page.state()["writers"].as_array().unwrap().iter().filter(|row| row[0] == json!(index)).count(), 1);
}

#[test]
fn alarms_come_with_their_cause() {
    let page = Page::open(|_| {});
    page.step_to(500);
    page.command(&json!({"fault": {"axis": "X", "kind": "drive_fault"}}));
    page.command(&json!({"step": 20}));
    until(|| page.state()["now"]["alarms"].as_array().is_some_and(|alarms| !alarms.is_empty()));
    until(|| page.state()["now"]["alarms"][0]["because"].is_string());
    let alarm = page.state()["now"]["alarms"][0].clone();
    assert!(alarm["text"].as_str().unwrap().contains('X') && alarm["time"].as_f64().unwrap() > 1.0, "{alarm}");
    // Behind it, and back to a moment at which it was pending: the cause is still known.
    page.command(&json!({"step": 80}));
    page.command(&json!({"go_back": 550}));
    page.command(&json!({"step": 1}));
    until(|| page.state()["now"]["cycle"] == json!(551));
    assert_eq!(page.state()["now"]["alarms"][0], alarm);
}

/// There are 128 places. A client that has done nothing for a second loses its place to a new one.
#[test]
fn silent_clients_keep_nobody_out() {
    let page = Page::open(|_| {});
    let mut silent: Vec<_> = (0..128).map(|_| page.connect()).collect();
    for stream in silent.iter_mut().skip(64) {
        stream.write_all(b"GET /api/state HT").unwrap();
    }
    std::thread::sleep(Duration::from_millis(1_200));
    let begin = Instant::now();
    assert!(page.get("/api/state").starts_with('{'));
    assert!(begin.elapsed() < Duration::from_secs(5), "it waits for the end of the others: {:?}", begin.elapsed());
}

/// A client that reads nothing gets a snapshot when it reads again; the machine and other clients go on.
#[test]
fn a_slow_client_holds_up_nobody() {
    let page = Page::open(|_| {});
    let mut slow = Events::open(&page);
    assert_eq!(slow.next().0, "snapshot");
    let silent: Vec<_> = (0..50).map(|_| page.connect()).collect();
    let begin = page.cycle();
    let mut quick = Events::open(&page);
    // More than a connection and the queue of a client hold.
    page.command(&json!({"speed": 20}));
    let mut steps = 0;
    while steps < 300 {
        let (name, event) = quick.next();
        steps += u32::from(name == "step");
        assert_eq!(event["now"]["ended"], false);
    }
    assert!(page.cycle() > begin + 1000);
    drop(silent);
    page.get("/api/state");
}

#[test]
fn malformed_requests_end_only_themselves() {
    let page = Page::open(|_| {});
    for bytes in [
        &b"\x03\x00\x00\x16"[..],
        b"GET / HTTP/9.9\r\n\r\n",
        b"\r\n\r\n\r\n",
        &[b'A'; 100_000],
        b"GET /events HTTP/1.1\r\nHost: ",
    ] {
        let mut stream = page.connect();
        let _ = stream.write_all(bytes);
    }
    let mut stream = page.connect();
    let _ = stream.write_all(b"GET / HTTP/1.1\r\nHost: localhost\r\n");
    for _ in 0..20_000 {
        if stream.write_all(b"a: bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb\r\n").is_err() {
            break;
        }
    }
    page.get("/api/state");
    let before = page.cycle();
    until(|| page.cycle() > before + 10);
}

/// The state at cycle 900 is the same to the last byte, although commands came before and after it.
#[test]
fn the_machine_goes_back_in_time_and_on_from_there() {
    let page = Page::open(|_| {});
    let steps = |cycle, body: Value| {
        page.step_to(cycle);
        page.command(&body);
    };
    steps(300, json!({"set": {"mode_group_1.mode_jog": 1, "mode_group_1.machine_function_ref": 1}}));
    steps(640, json!({"set": {"X.traversing_key_plus": 1}}));
    page.step_to(900);
    let then = page.live.with(|machine| machine.save());
    steps(900, json!({"fault": {"axis": "XF", "kind": "block"}}));
    page.step_to(2000);
    assert_ne!(page.live.with(|machine| machine.save()), then);
    let mut events = Events::open(&page);
    events.next();
    assert_eq!(page.command(&json!({"go_back": 900})), 900);
    assert_eq!(page.live.with(|machine| machine.save()), then);
    assert_eq!(page.state()["now"]["paused"], true);
    while events.next().1["now"]["cycle"] != json!(900) {}
    // Another way on: without the fault, and with more commands.
    steps(950, json!({"set": {"M0.0": 1}}));
    page.step_to(1500);
    let end = page.live.with(|machine| machine.save());
    // The session as a scenario is the machine's new past, without the time that it took back.
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("session_of_page.toml");
    std::fs::write(&file, page.get("/api/recording")).unwrap();
    let scenario = Scenario::read(&file).unwrap();
    let profile = scenario.profiles[0];
    let finished = scenario.prepare(profile, &Programs::ready()).unwrap().run();
    assert!(finished.failure.is_none());
    assert_eq!(finished.session().machine().save(), end);
}

#[test]
fn the_phase_of_the_gantry_and_what_it_waits_for() {
    let page = Page::open(|_| {});
    page.command(&json!({"set": {"mode_group_1.mode_jog": 1, "mode_group_1.machine_function_ref": 1}}));
    page.command(&json!({"speed": 10}));
    let phase = || page.state()["now"]["positions"][0]["phase"].as_str().unwrap_or_default().to_owned();
    assert_eq!(phase(), "NotSynchronised");
    let why = |signal: &str| page.get(&format!("/api/why?signal={signal}&value=1"));
    assert!(why("X.gantry_grouping_is_synchronized").contains("\"holds\":false"));
    page.command(&json!({"set": {"X.traversing_key_plus": 1}}));
    until(|| phase() == "ReferencingLeadingAxis");
    assert_eq!(page.ask("GET", "/api/why?signal=X.feed_override", "", "").0, 400);
}
