//! Hostile conversations: read from `conversations.txt`, and generated.

mod rules;

/// One conversation.
#[derive(Clone, Debug)]
pub(super) struct Conversation {
    /// Its name.
    pub(super) name: String,
    /// The actions of the client.
    pub(super) acts: Vec<Act>,
}

/// An action of a client.
#[derive(Clone, Debug)]
pub(super) enum Act {
    /// Sends these bytes.
    Send(Vec<u8>),
    /// Waits for this many milliseconds.
    Pause(u64),
}

/// All conversations.
pub(super) fn conversations() -> Vec<Conversation> {
    let mut all = read(include_str!("conversations.txt"));
    all.extend(rules::conversations());
    all
}

impl Conversation {
    fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), acts: Vec::new() }
    }

    fn ready(name: impl Into<String>) -> Self {
        Self::ready_at(2, name)
    }

    fn ready_at(slot: u8, name: impl Into<String>) -> Self {
        let mut conversation = Self::new(name);
        conversation.connect_to(slot);
        conversation.set_up(480);
        conversation
    }

    fn send(&mut self, bytes: impl Into<Vec<u8>>) {
        self.acts.push(Act::Send(bytes.into()));
    }

    /// The connection request of snap7: TPDU 1024, TSAPs 0100 and 0102.
    fn connect(&mut self) {
        self.connect_to(2);
    }

    fn connect_to(&mut self, slot: u8) {
        self.send([3, 0, 0, 22, 17, 0xE0, 0, 0, 0, 1, 0, 0xC0, 1, 10, 0xC1, 2, 1, 0, 0xC2, 2, 1, slot]);
    }

    fn set_up(&mut self, pdu: u16) {
        let [high, low] = pdu.to_be_bytes();
        self.job(&[0xF0, 0, 0, 1, 0, 1, high, low], &[]);
    }

    /// A piece of a PDU in a separate packet.
    fn piece(&mut self, piece: &[u8], is_last: bool) {
        let [high, low] = length(piece.len() + 7);
        self.send([&[3, 0, high, low, 2, 0xF0, if is_last { 0x80 } else { 0 }], piece].concat());
    }

    fn data(&mut self, pdu: &[u8]) {
        self.piece(pdu, true);
    }

    fn job(&mut self, parameter: &[u8], data: &[u8]) {
        self.pdu(1, parameter, data);
    }

    fn ask(&mut self, group: u8, function: u8, payload: &[u8]) {
        let head = if payload.is_empty() { [0x0A, 0] } else { [0xFF, 9] };
        let data = [&head[..], &length(payload.len()), payload].concat();
        self.pdu(7, &[0, 1, 0x12, 4, 0x11, 0x40 | group, function, 0], &data);
    }

    fn pdu(&mut self, kind: u8, parameter: &[u8], data: &[u8]) {
        // The reference is a counter, so that no two answers are the same.
        let [a, b] = length(self.acts.len());
        let head = [0x32, kind, 0, 0, a, b];
        self.data(&[&head[..], &length(parameter.len()), &length(data.len()), parameter, data].concat());
    }
}

fn length(bytes: usize) -> [u8; 2] {
    u16::try_from(bytes).expect("a conversation is written with lengths that fit").to_be_bytes()
}

/// Reads the file; its head describes the format.
fn read(text: &str) -> Vec<Conversation> {
    let mut all: Vec<Conversation> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.split_once('#').map_or(line, |(line, _)| line).trim();
        if let Some(name) = line.strip_prefix("== ") {
            all.push(Conversation::new(name));
        } else if !line.is_empty() {
            let conversation = all.last_mut().expect("a conversation begins with its name");
            act(conversation, line).unwrap_or_else(|| panic!("conversations.txt:{}: {line}", number + 1));
        }
    }
    all
}

fn act(conversation: &mut Conversation, line: &str) -> Option<()> {
    if let Some((many, times)) = line.rsplit_once(")*").filter(|_| line.starts_with('(')) {
        let times: usize = times.parse().ok()?;
        return (0..times).try_for_each(|_| act(conversation, &many[1..]));
    }
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    match word {
        "connect" => conversation.connect(),
        "nck" => {
            conversation.connect_to(4);
            conversation.set_up(rest.parse().ok()?);
        }
        "ready" => {
            conversation.connect();
            conversation.set_up(rest.parse().ok()?);
        }
        "send" => conversation.send(bytes(rest)?),
        "data" => conversation.data(&bytes(rest)?),
        "more" => conversation.piece(&bytes(rest)?, false),
        "pause" => conversation.acts.push(Act::Pause(rest.parse().ok()?)),
        "job" => {
            let (parameter, data) = rest.split_once('/')?;
            conversation.job(&bytes(parameter)?, &bytes(data)?);
        }
        "ask" => match bytes(rest)?.as_slice() {
            [group, function, payload @ ..] => conversation.ask(*group, *function, payload),
            _ => return None,
        },
        _ => return None,
    }
    Some(())
}

/// Parses `0A 0B "text" (01 02)*3`.
fn bytes(hex: &str) -> Option<Vec<u8>> {
    let (mut found, mut rest) = (Vec::new(), hex.trim());
    while !rest.is_empty() {
        if let Some(open) = rest.strip_prefix('(') {
            let (many, behind) = open.split_once(")*")?;
            let (times, behind) = behind.split_once(' ').unwrap_or((behind, ""));
            found.extend(bytes(many)?.repeat(times.parse().ok()?));
            rest = behind;
        } else if let Some(text) = rest.strip_prefix('"') {
            let (text, behind) = text.split_once('"')?;
            found.extend(text.as_bytes());
            rest = behind;
        } else {
            let (byte, behind) = rest.split_once(' ').unwrap_or((rest, ""));
            found.push(u8::from_str_radix(byte, 16).ok()?);
            rest = behind;
        }
        rest = rest.trim();
    }
    Some(found)
}
