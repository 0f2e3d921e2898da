//! The client of this project against its server: a live machine, and every request of the client.

use std::net::SocketAddr;
use std::time::Duration;

use opennck::image::{Area, Format, Preset, Width};
use opennck::live::{Live, Speed};
use opennck::machine::{Machine, OpenOptions};
use opennck::s7::client::{BlockKind, Client, Error, Memory, Mode, Options, Value, Variable};
use opennck::s7::live::LiveServer;
use opennck::s7::server::Limits;
use opennck::s7::{CpuState, DateAndTime, Restart};

/// A running machine and its server.
struct Served {
    window: Option<LiveServer>,
    live: Live,
    address: SocketAddr,
}

impl Served {
    fn start() -> Self {
        Self::with(Machine::open("g1_example").expect("it is built in"))
    }

    fn with(machine: Machine) -> Self {
        let live = Live::start(machine, Speed::default());
        let window = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default()).expect("some port is free");
        let address = window.addresses()[0];
        Self { window: Some(window), live, address }
    }

    async fn client(&self, options: Options) -> Client {
        Client::connect(&self.address.to_string(), options).await.expect("the server is there")
    }

    /// Restarts the server at the same address.
    fn restart(&mut self) {
        self.window = None;
        let address = self.address.to_string();
        let window = LiveServer::open(&self.live, &[&address], false, Limits::default());
        self.window = Some(window.expect("the port is free again"));
    }
}

fn variable(text: &str) -> Variable {
    text.parse().expect("it is a variable")
}

#[tokio::test]
async fn values_are_written_and_read_by_address() {
    let served = Served::start();
    let plc = served.client(Options::default()).await;
    let writes = [
        ("M10.3", Value::Bit(true)),
        ("MB20", Value::Byte(0xD0)),
        ("MW22", Value::Word(0x1234)),
        ("MW24:INT", Value::Int(-2)),
        ("MD26:DINT", Value::DoubleInt(-70_000)),
        ("MD30:REAL", Value::Real(1.5)),
        ("MB40..43", Value::Bytes(vec![1, 2, 3, 4])),
        ("MW50..54", Value::List(vec![Value::Word(1), Value::Word(2), Value::Word(3)])),
    ];
    let writes: Vec<_> = writes.into_iter().map(|(text, value)| (variable(text), value)).collect();
    let results = plc.write_all(&writes).await;
    assert!(results.iter().all(Result::is_ok), "{results:?}");
    let (variables, values): (Vec<_>, Vec<_>) = writes.into_iter().unzip();
    let found: Vec<_> = plc.read_all(&variables).await.into_iter().collect::<Result<_, _>>().unwrap();
    assert_eq!(found, values);
    // Bits of one byte; the other bits stay unchanged.
    plc.write(&variable("MB60"), &Value::Byte(0b1000_0001)).await.unwrap();
    let group = Variable::Memory(Memory {
        area: Area::Flags,
        byte: 60,
        width: Width::Bits { first: 2, last: 4 },
        format: Format::Unsigned,
        count: 1,
    });
    plc.write(&group, &Value::Byte(0b110)).await.unwrap();
    assert_eq!(plc.read(&variable("MB60")).await, Ok(Value::Byte(0b1001_1001)));
    assert_eq!(plc.read(&group).await, Ok(Value::Byte(0b110)));
}

/// 1000 items over a PDU of 240 bytes; some of them do not exist.
#[tokio::test]
async fn any_number_of_items_goes_through_the_shortest_pdu() {
    let served = Served::start();
    let plc = served.client(Options { pdu: 240, ..Options::default() }).await;
    assert_eq!(plc.negotiated().map(|negotiated| negotiated.pdu), Some(240));
    let bytes: Vec<u8> = (0..=255).collect();
    plc.write_bytes(Area::Flags, 0, &bytes).await.unwrap();
    assert_eq!(plc.read_bytes(Area::Flags, 0, 256).await, Ok(bytes));
    let variables: Vec<Variable> = (0..1000_u32)
        .map(|at| if at % 100 == 99 { variable("DB999.DBB0") } else { variable(&format!("MB{}", at % 256)) })
        .collect();
    let values = plc.read_all(&variables).await;
    for (at, value) in (0_u32..).zip(values) {
        if at % 100 == 99 {
            assert_eq!(value, Err(Error::Refused { what: "DB999.DBB0".to_owned(), code: 0x0A }));
        } else {
            assert_eq!(value, Ok(Value::Byte(u8::try_from(at % 256).unwrap())));
        }
    }
}

#[tokio::test]
async fn a_module_is_identified() {
    let served = Served::start();
    let plc = served.client(Options { pdu: 240, ..Options::default() }).await;
    let all = plc.list(0, 0).await.unwrap();
    assert_eq!((usize::from(all.count), all.record), (all.records().count(), 2));
    let identification = plc.identification().await.unwrap();
    assert_eq!(identification.order_number, "6ES7 317-2EK14-0AB0");
    assert_eq!(identification.version, "V3.2.6");
    assert_eq!(identification.system_name, "OpenNCK");
    assert!(matches!(plc.list(0x0042, 0).await, Err(Error::Rejected { .. })));
    assert_eq!(plc.protection().await, Ok(Some(1)));
    let time = DateAndTime { year: 2031, month: 2, day: 28, hour: 23, minute: 59, second: 1, millisecond: 0 };
    plc.set_clock(time).await.unwrap();
    let shown = plc.clock().await.unwrap();
    assert_eq!((shown.year, shown.month, shown.day, shown.hour), (2031, 2, 28, 23));
}

#[tokio::test]
async fn the_plc_is_stopped_and_started() {
    let served = Served::start();
    let plc = served.client(Options::default()).await;
    let until = async |state| {
        for _ in 0..200 {
            if plc.cpu_state().await.unwrap() == Some(state) {
                return;
            }
            tokio::time::sleep(Duration::from_millis(10)).await;
        }
        panic!("it never was in {state:?}");
    };
    until(CpuState::Run).await;
    plc.start_plc(Restart::Warm).await.unwrap(); // it is already in RUN
    plc.stop_plc().await.unwrap();
    until(CpuState::Stop).await;
    plc.stop_plc().await.unwrap();
    plc.start_plc(Restart::Warm).await.unwrap();
    until(CpuState::Run).await;
}

#[tokio::test]
async fn blocks_are_listed_described_and_uploaded() {
    let served = Served::start();
    let plc = served.client(Options { pdu: 240, ..Options::default() }).await;
    let blocks = plc.blocks(BlockKind::Db).await.unwrap();
    let counts = plc.block_counts().await.unwrap();
    let of_db = counts.iter().find(|count| count.kind == BlockKind::Db).unwrap();
    assert_eq!(usize::from(of_db.count), blocks.len());
    assert!(blocks.iter().any(|block| block.number == 31));
    assert_eq!(plc.blocks(BlockKind::Fc).await, Ok(Vec::new()));
    let block = plc.describe_block(BlockKind::Db, 31).await.unwrap();
    assert_eq!((block.number, block.language, block.length), (31, 5, 148)); // O-24
    let uploaded = plc.upload(BlockKind::Db, 31).await.unwrap();
    assert_eq!(uploaded.len(), usize::try_from(block.load_memory).unwrap());
    let read = plc.read_bytes(Area::DataBlock(31), 0, 148).await.unwrap();
    assert_eq!(uploaded[36 + 100..36 + 102], read[100..102]);
    assert!(matches!(plc.describe_block(BlockKind::Db, 999).await, Err(Error::Rejected { .. })));
}

#[tokio::test]
async fn variables_of_the_nck_are_read_by_name() {
    let served = Served::start();
    let nck = served.client(Options::nck()).await;
    let names = nck.read(&variable("nck:N/$MN_AXCONF_MACHAX_NAME_TAB[1..3]")).await.unwrap();
    let text = |text: &str| Value::Text(text.to_owned());
    assert_eq!(names, Value::List(vec![text("X"), text("Y"), text("XF")]));
    let many = ["C/MachineAxis/actToolBasePos[1..3]", "B/State/opMode", "N/M/10000:TEXT32[3]"].map(variable);
    let values = nck.read_all(&many).await;
    assert!(matches!(&values[0], Ok(Value::List(positions)) if positions.len() == 3), "{values:?}");
    assert_eq!(values[1], Ok(Value::Word(0))); // JOG
    assert_eq!(values[2], Ok(text("XF")));
    // No position was written.
    let error = nck.write(&variable("nck:C/MachineAxis/actToolBasePos"), &Value::Double(1.0)).await.unwrap_err();
    assert!(matches!(error, Error::Refused { code: 3, .. }), "{error}");
}

/// The server restarts: reads continue, subscriptions are renewed.
#[tokio::test]
async fn a_client_reconnects_to_a_restarted_server() {
    let mut served = Served::start();
    let plc = served.client(Options::default()).await;
    plc.write(&variable("MB1"), &Value::Byte(7)).await.unwrap();
    let memory = [variable("MB1"), variable("DB999.DBB0")];
    let mut values = plc.subscribe(&memory, Mode::Cycle, Duration::from_millis(100)).await.unwrap();
    let update = values.next().await.unwrap().unwrap();
    assert_eq!(update.values[0], (0, Ok(Value::Byte(7))));
    assert!(matches!(update.values[1], (1, Err(Error::Refused { .. }))));
    served.restart();
    assert_eq!(plc.read(&memory[0]).await, Ok(Value::Byte(7)));
    plc.write(&memory[0], &Value::Byte(8)).await.unwrap();
    let again = async { while values.next().await.unwrap().unwrap().values[0] != (0, Ok(Value::Byte(8))) {} };
    tokio::time::timeout(Duration::from_secs(10), again).await.expect("values come again");
}

/// A block of a PLC image with the maximum length: 65535 / 942 = 70 requests, eight in parallel.
#[tokio::test]
async fn the_longest_block_is_read_in_parts() {
    let preset = Preset::parse("[[db]]\nnumber = 2000\nsize = 65535\nfill = \"01 02 03\"\n", "long.toml").unwrap();
    let options = OpenOptions { preset: Some(preset), ..OpenOptions::default() };
    let served = Served::with(Machine::open_with("g1_example", options).unwrap());
    let plc = served.client(Options::default()).await;
    let bytes = plc.read_bytes(Area::DataBlock(2000), 0, 65_535).await.unwrap();
    assert_eq!(bytes.len(), 65_535);
    assert!(bytes.chunks(3).all(|three| three == [1, 2, 3]));
    let beyond = plc.read_bytes(Area::DataBlock(2000), 65_534, 2).await;
    assert!(matches!(beyond, Err(Error::Refused { code: 5, .. })), "{beyond:?}");
    assert_eq!(plc.upload(BlockKind::Db, 2000).await.unwrap()[36..36 + 65_535], bytes);
}
