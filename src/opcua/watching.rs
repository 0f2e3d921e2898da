//! The values that clients subscribe to. Every step of the machine is compared with the one before, so that each edge arrives, with the
//! instant of its step. The stepping thread only puts the steps into a queue (`live/steps.rs`).

use std::collections::BTreeMap;
use std::time::{SystemTime, UNIX_EPOCH};

use opcua::server::{MonitoredItemHandle, SubscriptionCache};
use opcua::types::{AttributeId, DataValue, DateTime, NodeId, StatusCode, Variant};

use super::node_id::{Id, Type};
use super::reading::{Reader, Terms, number, with_reader};
use crate::image::{Location, Memory, Part};
use crate::live::{Handle, Seen, Steps};

/// The most values that are handed over at once.
const MOST: usize = 4096;

/// What clients subscribe to.
#[derive(Debug)]
pub(super) struct Watching {
    live: Handle,
    serial_number: String,
    steps: Steps,
    /// By the text of the node id.
    watched: BTreeMap<String, Watched>,
    /// The texts of the node ids, by the numbers of subscription and item.
    handles: BTreeMap<(u32, u32), String>,
    /// The last step that was compared.
    last: Option<Box<Seen>>,
    /// The number of steps that were lost.
    lost: u64,
}

#[derive(Debug)]
struct Watched {
    node: NodeId,
    id: Id,
    /// The number of items of clients.
    items: usize,
    /// The step of the first value.
    since: u64,
    /// Where a plain number lies, and its bits.
    place: Option<(Location, Type, u64)>,
    value: Result<Variant, StatusCode>,
}

impl Watching {
    pub(super) fn new(live: Handle, serial_number: String) -> Self {
        let steps = live.steps();
        Self { live, serial_number, steps, watched: BTreeMap::new(), handles: BTreeMap::new(), last: None, lost: 0 }
    }

    /// Each step counts from now on.
    pub(super) fn begin(&mut self) {
        self.steps.listen(true);
    }

    /// Adds an item of a client, and returns its first value.
    pub(super) fn add(
        &mut self,
        handle: MonitoredItemHandle,
        node: &NodeId,
        text: &str,
        id: &Id,
    ) -> Result<DataValue, StatusCode> {
        self.begin();
        let terms = Terms { speed: self.live.speed().ratio(), serial_number: &self.serial_number };
        let (since, value, place) =
            self.live.look(|seen| with_reader(seen, terms, |reader| (seen.step(), reader.read(id), place(id, reader))));
        let value = value?;
        let watched = self.watched.entry(text.to_owned()).or_insert_with(|| Watched {
            node: node.clone(),
            id: id.clone(),
            items: 0,
            since,
            place,
            value: Ok(value.clone()),
        });
        watched.items += 1;
        self.handles.insert(key(handle), text.to_owned());
        Ok(DataValue::new_at(value, DateTime::now()))
    }

    pub(super) fn remove(&mut self, handle: MonitoredItemHandle) {
        let Some(text) = self.handles.remove(&key(handle)) else { return };
        if let Some(watched) = self.watched.get_mut(&text) {
            watched.items -= 1;
            if watched.items == 0 {
                self.watched.remove(&text);
            }
        }
    }

    /// Compares the steps since the last call; `each` gets every step with its instant.
    pub(super) fn advance(&mut self, subscriptions: &SubscriptionCache, mut each: impl FnMut(&Seen, DateTime)) {
        let terms = Terms { speed: self.live.speed().ratio(), serial_number: &self.serial_number };
        let mut edges: Vec<(NodeId, DataValue)> = Vec::new();
        for step in self.steps.take() {
            let instant = instant(step.instant);
            let before = self.last.take();
            let before = before.as_ref().map(|seen| seen.machine().memory());
            let mut changed = Changed { before, now: step.seen.machine().memory(), parts: Vec::new() };
            with_reader(&step.seen, terms, |reader| {
                // The first value of an item may be of a later step than those that wait here.
                for watched in self.watched.values_mut().filter(|watched| watched.since < step.seen.step()) {
                    if watched.look(reader, &mut changed) {
                        edges.push((watched.node.clone(), watched.data_value(instant)));
                    }
                }
            });
            each(&step.seen, instant);
            self.last = Some(step.seen);
            if edges.len() > MOST {
                hand_over(subscriptions, &mut edges);
            }
        }
        hand_over(subscriptions, &mut edges);
        let lost = self.steps.lost();
        if lost > self.lost {
            let steps = lost - self.lost;
            tracing::warn!(
                "OPC UA: {steps} cycles were not compared, because this computer is busy: clients may miss edges"
            );
            self.lost = lost;
        }
    }
}

fn key(handle: MonitoredItemHandle) -> (u32, u32) {
    (handle.subscription_id, handle.monitored_item_id)
}

/// The notifier sends when it is dropped.
fn hand_over(subscriptions: &SubscriptionCache, edges: &mut Vec<(NodeId, DataValue)>) {
    if edges.is_empty() {
        return;
    }
    let mut notifier = subscriptions.data_notifier();
    for (node, value) in edges.drain(..) {
        if let Some(mut items) = notifier.notify_for(&node, AttributeId::Value) {
            items.data_value(value);
        }
    }
}

/// The instant of a step, never in the future.
pub(super) fn instant(instant: SystemTime) -> DateTime {
    let since = instant.duration_since(UNIX_EPOCH).unwrap_or_default();
    let hundreds = i64::try_from(since.as_nanos() / 100).unwrap_or(0);
    DateTime::from(hundreds + super::reading::EARLIER * 10_000)
}

fn place(id: &Id, reader: &Reader<'_>) -> Option<(Location, Type, u64)> {
    let Id::Plc(plc) = id else { return None };
    let location = reader.location(plc)?;
    Some((location, plc.kind, reader.machine().memory().read(location)))
}

/// The parts of the memory that changed in a step.
struct Changed<'a> {
    before: Option<&'a Memory>,
    now: &'a Memory,
    parts: Vec<(Part, bool)>,
}

impl Changed<'_> {
    fn has(&mut self, part: Part) -> bool {
        if let Some((_, has_changed)) = self.parts.iter().find(|(known, _)| *known == part) {
            return *has_changed;
        }
        let has_changed = self.before.is_none_or(|before| before.part(part) != self.now.part(part));
        self.parts.push((part, has_changed));
        has_changed
    }
}

impl Watched {
    /// Whether the value has changed.
    fn look(&mut self, reader: &Reader<'_>, changed: &mut Changed<'_>) -> bool {
        if let Some((location, kind, bits)) = &mut self.place {
            if !changed.has(location.part) || !changed.now.contains(*location) {
                return false;
            }
            let now = changed.now.read(*location);
            if now == *bits {
                return false;
            }
            *bits = now;
            self.value = Ok(number(*kind, u32::try_from(now).unwrap_or(u32::MAX)));
            return true;
        }
        let value = reader.read(&self.id);
        let has_changed = value != self.value;
        self.value = value;
        has_changed
    }

    fn data_value(&self, instant: DateTime) -> DataValue {
        match &self.value {
            Ok(value) => {
                DataValue { server_timestamp: Some(DateTime::now()), ..DataValue::new_at(value.clone(), instant) }
            }
            Err(status) => DataValue { status: Some(*status), source_timestamp: Some(instant), ..DataValue::null() },
        }
    }
}
