//! `opennck s7` as users call it, against `opennck serve`; and the commands of the README and of `docs/`.

use std::fs;
use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use crate::processes::{self, EndsWithTest};

pub(crate) fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
    command.args(arguments).current_dir(Path::new(env!("CARGO_MANIFEST_DIR")));
    command
}

/// A server on any free port.
pub(crate) struct Served {
    child: Child,
    _ends: EndsWithTest,
    pub(crate) host: String,
}

impl Served {
    pub(crate) fn start() -> Self {
        Self::with(&[])
    }

    fn with(more: &[&str]) -> Self {
        let arguments = ["serve", "g1_example", "--plc-image", "recipes", "--s7", "127.0.0.1:0"];
        let mut child =
            program(&arguments).args(more).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("it was built");
        let ends = EndsWithTest::new(&child);
        let lines = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        let mut ports = lines
            .map_while(Result::ok)
            .filter_map(|line| Some(line.split_once("127.0.0.1:")?.1.split(':').next()?.to_owned()));
        let port = ports.next().expect("the output has the port");
        Self { child, _ends: ends, host: format!("127.0.0.1:{port}") }
    }

    /// `opennck s7 COMMAND HOST …`.
    fn s7(&self, command: &str, arguments: &[&str]) -> Output {
        program(&["s7", command, &self.host]).args(arguments).output().expect("it was built")
    }

    pub(crate) fn text(&self, command: &str, arguments: &[&str]) -> String {
        let output = self.s7(command, arguments);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).expect("it is text")
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The words of each line after its heading.
fn rows(text: &str) -> Vec<Vec<&str>> {
    text.lines().skip(1).map(|line| line.split_whitespace().collect()).collect()
}

#[test]
fn it_reads_addresses_symbols_and_nc_variables() {
    let served = Served::start();
    let arguments = ["DB1000.DBW2", "DB1000.DBD4:REAL", "DB1001.DBB0..3", "XF.feed_override", "nck:N/Y/maxnumAlarms"];
    let text = served.text("read", &arguments);
    let rows = rows(&text);
    assert_eq!(rows[0], ["DB1000.DBW2", "WORD", "250", "00", "FA"]);
    assert_eq!(rows[1], ["DB1000.DBD4:REAL", "REAL", "1.5", "3F", "C0", "00", "00"]);
    assert_eq!(rows[2], ["DB1001.DBB0..3", "BYTE[4]", "8C", "00", "FF", "8C"]);
    assert_eq!(rows[3][..3], ["DB33.DBB0", "XF.feed_override", "BYTE"]);
    assert_eq!(rows[4][..2], ["nck:N/Y/maxnumAlarms", "WORD"]);
    let json: serde_json::Value =
        serde_json::from_str(&served.text("read", &["DB1000.DBW2", "--format", "json"])).expect("it is JSON");
    assert_eq!((&json[0]["value"], &json[0]["hex"]), (&250.into(), &"00 FA".into()));
    let csv = served.text("read", &["DB1000.DBW2", "--format", "csv"]);
    assert_eq!(csv, "address,symbol,type,value,hex,meaning\nDB1000.DBW2,,WORD,250,00 FA,\n");
}

#[test]
fn a_refusal_ends_with_1_and_the_other_values_are_shown() {
    let served = Served::start();
    let output = served.s7("read", &["DB1000.DBW2", "DB999.DBB0"]);
    let (out, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(out.contains("250") && out.contains("refused: the object does not exist (return code 0A)"), "{out}");
    assert!(error.contains("DB999.DBB0: the object does not exist"), "{error}");
}

/// Numbers are JSON numbers and bits are booleans: text would be compared wrongly.
#[test]
fn json_has_numbers_and_booleans() {
    let served = Served::start();
    let asked =
        ["DB1000.DBD4:REAL", "DB1001.DBB0..3", "DB31.DBX0.0", "nck:C/MachineAxis/name[1..2]", "nck:N/Y/maxnumAlarms"];
    let json: serde_json::Value =
        serde_json::from_str(&served.text("read", &[&asked[..], &["--format", "json"]].concat())).expect("it is JSON");
    let values: Vec<_> = json.as_array().unwrap().iter().map(|row| row["value"].clone()).collect();
    assert_eq!(values[..4], serde_json::json!([1.5, [0x8C, 0, 0xFF, 0x8C], false, ["X", "Y"]]).as_array().unwrap()[..]);
    assert!(values[4].is_u64(), "{values:?}");
}

/// DB31 is the block of axis X on this machine; 26 is position 19 in Gray code, 100 % (MD12010).
#[test]
fn addresses_have_the_names_and_the_meaning_that_the_control_gives_them() {
    let served = Served::start();
    let text = served.text("read", &["DB31.DBB0", "DB33.DBX101.6", "DB10.DBX106.1"]);
    let lines: Vec<&str> = text.lines().skip(1).collect();
    assert!(lines[0].contains(" X.feed_override ") && lines[0].contains("  100 %. Feed override: "), "{text}");
    assert!(lines[1].contains(" XF.gantry_leading_axis ") && lines[1].contains("Gantry leading axis: 1 on"), "{text}");
    let text = served.text("read", &["AX1.feed_override"]);
    assert!(text.contains("AX1.feed_override"), "{text}"); // AX1 on the command line is shown as AX1
}

/// The remedy is specific to the refusal: the TSAP of the NCK, the number of rows.
#[test]
fn a_refused_nc_variable_has_a_remedy() {
    let served = Served::start();
    let at_the_plc = &["--nck-tsap", "0100:0102", "nck:C/MachineAxis/actToolBasePos[1]"][..];
    for (arguments, said) in [
        (
            at_the_plc,
            &["nck:C/MachineAxis/actToolBasePos[1]: the module does not have", "8104", "--nck-tsap 0400:0D04"][..],
        ),
        (
            &["nck:C/MachineAxis/actToolBasePos[99]"],
            &["actToolBasePos[99]: the address", "3 machine axes: rows 1 to 3"],
        ),
        (&["nck:N/AlarmList/textIndex[99]"], &["alarm rows: rows 1 to "]),
        (&["nck:C/Parameter/rpa[60000]"], &["R5 is row 6"]),
        (&["nck:C/ProgramInfo/block[9]"], &["count from 1"]),
        (&["nck:A1/M/31999:DOUBLE"], &["nck:A1/M/31999:DOUBLE: ", "`opennck s7 nck`"]),
    ] {
        let output = served.s7("read", arguments);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {error}");
        assert!(said.iter().all(|said| error.contains(said)), "{arguments:?}: {error}");
    }
}

#[test]
fn a_wrong_password_ends_with_1_and_names_its_sources() {
    let served = Served::with(&["--password", "right"]);
    let output = served.s7("read", &["MB0", "--password", "wrong"]);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(error.contains("wrong password") && error.contains("check --password and OPENNCK_S7_PASSWORD"), "{error}");
    served.text("read", &["MB0", "--password", "right"]);
}

/// Twelve guesses in a queue would take 250 ms times 1 + 2 + 4 + … + 2048, more than 17 minutes. Of clients that have left, only the one that had
/// its turn counts, and perhaps the ones after it that were quicker than their end.
#[test]
fn guesses_of_clients_that_have_left_do_not_lock_out_the_right_password() {
    let served = Served::with(&["--password", "right", "--clients", "20"]);
    let guess = |_| {
        let arguments = ["s7", "read", &served.host, "MB0", "--password", "wrong", "--timeout", "100ms"];
        program(&arguments).stderr(Stdio::null()).spawn().expect("it was built")
    };
    let guesses: Vec<Child> = (0..12).map(guess).collect();
    for mut guess in guesses {
        assert_eq!(guess.wait().expect("it ends").code(), Some(2), "no answer within 100 ms");
    }
    served.text("read", &["MB0", "--password", "right"]);
}

#[test]
fn nc_variables_are_shown_as_they_were_written() {
    let served = Served::start();
    let asked = [
        "nck:C1/MachineAxis/actToolBasePos[1]",
        "nck:C/SMA/actToolBasePos[1]",
        "C/Parameter/rpa[6]",
        "A1/M/32000:DOUBLE",
    ];
    let text = served.text("read", &asked);
    let shown: Vec<&str> = rows(&text).iter().map(|row| row[0]).collect();
    assert_eq!(shown, [asked[0], asked[1], "nck:C/Parameter/rpa[6]", "nck:A1/M/32000:DOUBLE"]);
    served.text("write", &["nck:C/Parameter/rpa[6]=1.5"]);
    assert_eq!(rows(&served.text("read", &["nck:C/RP/1:DOUBLE[6]"]))[0][2], "1.5");
    // The type is the user's: the server did nothing wrong.
    let wrong = served.s7("read", &["A1/M/32000:WORD"]);
    let text = String::from_utf8_lossy(&wrong.stderr).into_owned();
    assert!(text.contains("nck:A1/M/32000:WORD: the type has 2 bytes, the value has 8\n"), "{text}");
    assert!(text.contains("write a type of 8 bytes (DOUBLE, DATE, TEXT8), or omit the type"), "{text}");
    assert_ne!(wrong.status.code(), Some(0));
}

#[test]
fn a_value_of_a_scenario_is_no_address() {
    let served = Served::start();
    let wrong = served.s7("read", &["X.position"]);
    let text = String::from_utf8_lossy(&wrong.stderr).into_owned();
    assert_eq!(wrong.status.code(), Some(2), "{text}");
    assert!(text.contains("found `X.position`, which is a value of the simulator"), "{text}");
    assert!(text.contains("`opennck s7 nck` lists"), "{text}");
}

#[test]
fn it_writes_as_scenarios_do() {
    let served = Served::start();
    let writes = ["DB1000.DBB10=16#D0", "DB1000.DBX11.3=true", "DB1000.DBD12:REAL=1.5", "DB1000.DBB16..18=1,2,2#11"];
    let text = served.text("write", &[&writes[..], &["Y.feed_override=100%"]].concat());
    assert!(text.contains("DB1000.DBB16..18"), "{text}");
    let text = served.text("read", &["DB1000.DBB10..18", "DB32.DBB0"]);
    let rows = rows(&text);
    assert_eq!(rows[0][2..], ["D0", "08", "3F", "C0", "00", "00", "01", "02", "03"]);
    // 100 % is position 19 of the switch, 19 ^ 19 >> 1 = 26 in Gray code (MD12000).
    assert_eq!(rows[1][3..7], ["26", "1A", "100", "%."]);
}

/// The second value replaces the first one, so that the first one reads back differently.
#[test]
fn a_write_that_the_nck_overwrites_or_that_reads_back_differently_has_a_warning() {
    let served = Served::start();
    let output = served.s7("write", &["MB5=1", "MB5=2", "MB6=3", "DB31.DBX101.7=0"]);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{error}");
    assert_eq!(error.matches("warning: ").count(), 2, "{error}");
    assert!(error.contains("warning: MB5 was written and reads back as 2: "), "{error}");
    assert!(
        error.contains("gantry_axis (DB31.DBX101.7) was written, but the NCK overwrites it in the same cycle"),
        "{error}"
    );
}

#[test]
fn unusable_input_ends_with_2_and_writes_nothing() {
    let served = Served::start();
    for (command, arguments, said) in [
        ("read", &["DB31.DBQ1"][..], ["DB31.DBQ1", "DB31.DBX101.5"]),
        ("read", &["X.controler_enable"], ["X.controler_enable", "controller_enable"]),
        ("read", &["Z9.controller_enable"], ["Z9", "X"]),
        ("read", &["nck:C/SMA/actToolBasePo"], ["actToolBasePo", "did you mean"]),
        ("read", &["MB0", "--profile", "840"], ["840", "840d_sl"]),
        ("read", &["nck:A1/M/99999:DOUBLE"], ["A1/M/99999:DOUBLE", "a column from 0 to 65535"]),
        ("read", &["nck:A1/M/32000:FLOAT"], ["a type after the column", "DOUBLE"]),
        ("read", &["nck:A1/MD/32000"], ["a module with its column", "SMA"]),
        ("write", &["DB1000.DBB20=1", "DB1000.DBB21=256"], ["256", "-128 to 255"]),
        ("write", &["DB1000.DBB20=1", "DB1000.DBB21"], ["DB1000.DBB21", "ADDRESS=VALUE"]),
        ("write", &["DB1000.DBB20=1", "DB1000.DBW22=1.5"], ["whole number", ":REAL"]),
        ("szl", &["zz"], ["zz", "hexadecimal"]),
    ] {
        let output = served.s7(command, arguments);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(said.iter().all(|said| error.contains(said)), "{arguments:?}: {error}");
    }
    assert_eq!(rows(&served.text("read", &["DB1000.DBB20"]))[0][2], "0");
}

#[test]
fn an_unreachable_host_ends_with_2_and_a_remedy() {
    let free = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().to_string();
    for command in ["read", "watch"] {
        let output = program(&["s7", command, &free, "MB0"]).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(error.contains(&free) && error.contains("check the address, the port"), "{error}");
    }
}

#[test]
fn info_identifies_a_module() {
    let served = Served::start();
    let info = served.text("info", &[]);
    for said in ["PLC 317-2 PN/DP", "RUN", "148 bytes", "X at ", "JOG", "6ES7 317-2EK14-0AB0"] {
        assert!(info.contains(said), "{said} is missing:\n{info}");
    }
    assert!(served.text("szl", &["001C"]).contains("manufacturer: 002A"));
    let list = served.text("szl", &["0011"]);
    assert!(list.contains("records of 28 bytes") && list.contains("module 6ES7 317-2EK14-0AB0"), "{list}");
    assert_eq!(served.s7("szl", &["0042"]).status.code(), Some(1));
    let catalogue = program(&["s7", "nck", "actToolBasePos"]).output().unwrap();
    assert!(String::from_utf8_lossy(&catalogue.stdout).contains("nck:C/MachineAxis/actToolBasePos"));
    let catalogue = program(&["s7", "nck", "actTolBasePos"]).output().unwrap();
    let error = String::from_utf8_lossy(&catalogue.stderr).into_owned();
    assert_eq!(catalogue.status.code(), Some(1), "{error}");
    assert!(error.contains("actTolBasePos") && error.contains("C/MachineAxis/actToolBasePos"), "{error}");
}

#[test]
#[cfg(unix)]
fn watching_prints_a_line_for_each_change_and_ends_with_0() {
    let served = Served::start();
    for how in [&["--every", "20ms"][..], &["--every", "100ms", "--cyclic"]] {
        served.text("write", &["MB1=1"]);
        let mut command = program(&["s7", "watch", &served.host, "MB1"]);
        let mut child = command.args(how).stdout(Stdio::piped()).spawn().unwrap();
        let _ends = EndsWithTest::new(&child);
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let mut next = || lines.next().unwrap().unwrap().split_whitespace().skip(1).collect::<Vec<_>>().join(" ");
        assert_eq!(next(), "MB1 1");
        served.text("write", &["MB1=2"]);
        assert_eq!(next(), "MB1 1 -> 2");
        assert_eq!(processes::end(&mut child, "-INT").code(), Some(0));
    }
}

/// As with `| head -1`: no value changes, nothing is printed, and the command ends when its output is closed.
#[test]
#[cfg(target_os = "linux")]
fn watching_ends_when_its_output_is_closed() {
    let served = Served::start();
    let mut child = program(&["s7", "watch", &served.host, "MB1"]).stdout(Stdio::piped()).spawn().unwrap();
    let _ends = EndsWithTest::new(&child);
    let mut first = String::new();
    let mut lines = BufReader::new(child.stdout.take().unwrap());
    lines.read_line(&mut first).unwrap();
    drop(lines);
    assert!(first.contains("MB1"), "{first}");
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

/// The README and the pages of `docs/`, each with its path.
fn pages() -> Vec<(String, String)> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_dir(project.join("docs"))
        .expect("the project has it")
        .map(|entry| entry.expect("the project has it").path());
    let mut paths: Vec<_> = docs.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect();
    paths.push(project.join("README.md"));
    paths.sort();
    paths
        .into_iter()
        .map(|path| (path.display().to_string(), fs::read_to_string(path).expect("the project has it")))
        .collect()
}

fn serving() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/serving.md")).expect("the project has it")
}

/// The gantry recipe of `docs/serving.md` at twenty times real time; the test waits where the recipe watches.
#[test]
fn the_recipe_of_the_pages_references_a_gantry() {
    let page = serving();
    let recipe = page.split("### Referencing from a client").nth(1).unwrap().split("```").nth(1).unwrap();
    let served = Served::with(&["--plc", "enable_all", "--speed", "20"]);
    let wait = |symbol: &str| {
        let is_there = || rows(&served.text("read", &[symbol]))[0].contains(&"1");
        assert!((0..5000).any(|_| is_there()), "{symbol} does not come");
    };
    wait("X.gantry_leading_axis"); // the control has started up
    let mut done = 0;
    for line in recipe.lines().filter(|line| line.starts_with("opennck s7 ")) {
        let words: Vec<&str> = line.split(" #").next().unwrap().split_whitespace().skip(2).collect();
        match words[0] {
            "watch" => words[2..].iter().for_each(|symbol| wait(symbol)),
            "read" => wait(words[2]),
            command => drop(served.text(command, &words[2..])),
        }
        if words.contains(&"DB11.DBX1.2=1") {
            wait("DB11.DBX7.2");
        }
        if words.contains(&"X.start_gantry_synchronization=1") {
            wait("X.gantry_grouping_is_synchronized");
        }
        done += 1;
    }
    assert_eq!(done, 7, "{recipe}");
}

/// Each line of the pages that calls `opennck s7`, on a port that is free here.
#[test]
fn the_client_commands_of_the_pages_work() {
    let served = Served::start();
    let mut count = 0;
    // The page of the ISG kernel asks a machine of that control.
    for (path, page) in pages().into_iter().filter(|(path, _)| !path.ends_with("docs/isg.md")) {
        let lines =
            page.lines().filter(|line| line.starts_with("opennck s7 ") && !line.starts_with("opennck s7 watch"));
        for line in lines {
            let line = line.split(" #").next().unwrap().replace("127.0.0.1:10102", &served.host);
            let arguments: Vec<&str> = line.split_whitespace().skip(1).map(|word| word.trim_matches('\'')).collect();
            let output = program(&arguments).output().unwrap();
            let error = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(0), "{path}: {line}: {error}");
            count += 1;
        }
    }
    assert!(count >= 12, "the pages show {count} commands");
}

/// Each line of the pages that calls `opennck serve`, on a port that is free here: it starts.
#[test]
fn the_server_commands_of_the_pages_start() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("served_pages");
    let mut count = 0;
    for (path, page) in pages() {
        let has_it = |line: &&str| cfg!(feature = "opcua") || !line.contains("--opcua");
        for line in page.lines().filter(|line| line.starts_with("opennck serve ")).filter(has_it) {
            // A recording or an image of an earlier line would be refused.
            let _ = fs::remove_dir_all(&folder);
            fs::create_dir_all(&folder).unwrap();
            for block in page.split("```toml\n# ").skip(1) {
                let (name, rest) = block.split_once('\n').unwrap();
                if !name.contains(['/', ' ']) {
                    fs::write(folder.join(name), rest.split("```").next().unwrap()).unwrap();
                }
            }
            let root = env!("CARGO_MANIFEST_DIR");
            let here = |word: &str| match word {
                name if Path::new(root).join(name).exists() => format!("{root}/{name}"),
                "recipes" => format!("{root}/plc_images/recipes.toml"),
                other => other.to_owned(),
            };
            let words = line.split(" #").next().unwrap().split_whitespace().skip(1);
            let arguments: Vec<String> = words.filter(|word| *word != "&").map(here).collect();
            let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
            let command = command.args(arguments).args(["--s7", "127.0.0.1:0"]).current_dir(&folder);
            let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
            let _ends = EndsWithTest::new(&child);
            let lines = BufReader::new(child.stdout.take().unwrap()).lines();
            let started = lines.map_while(Result::ok).any(|line| line.contains("S7 on 127.0.0.1:"));
            let _ = child.kill();
            let _ = child.wait();
            assert!(started, "{path}: {line}");
            count += 1;
        }
    }
    assert!(count >= 6, "the pages show {count} servers");
}

/// NC variables in Python, as `docs/serving.md` shows; where there is no Python, nothing is tested.
#[test]
#[cfg(unix)]
fn the_python_function_of_the_pages_reads_nc_variables() {
    let page = serving();
    let code = page.split("```python\n").skip(1).find(|block| block.contains("subprocess")).unwrap();
    let served = Served::with(&["--plc", "enable_all"]);
    let code = code.split("```").next().unwrap().replace("127.0.0.1:10102", &served.host);
    let folder = Path::new(env!("CARGO_BIN_EXE_opennck")).parent().unwrap().display();
    let path = format!("{folder}:{}", std::env::var("PATH").unwrap_or_default());
    let Ok(output) = Command::new("python3").args(["-c", &code]).env("PATH", path).output() else { return };
    let shown = code.lines().last().and_then(|line| line.split_once("  # ")).unwrap().1;
    assert_eq!(
        String::from_utf8_lossy(&output.stdout).trim_end(),
        shown,
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}
