//! Alarms as events of the type `CncAlarmType` of OPC 40502, from the Server object. Alarms are no nodes. A client that subscribes gets what
//! changes from then on; `ConditionRefresh` gives it what is pending.
//!
//! | field | value |
//! |---|---|
//! | `SourceName` | `NCK`, or `PLC` for the alarms of the PLC from 400000 on; no channel, as on a SINUMERIK |
//! | `Severity` | 1000 for an alarm with a reaction, 500 for one that is only shown |
//! | `AlarmIdentifier`, `AuxParameters` | the number; the place, then the parameters of its text |
//! | `HelpSource` | the cause: the rule and the inputs that it tested; empty if it is not known |
//! | `Retain`, `ActiveState/Id` | true while it is pending |

use opcua::nodes::{DefaultTypeTree, Event};
use opcua::server::SubscriptionCache;
use opcua::types::event_field::EventField;
use opcua::types::{
    AttributeId, ByteString, DateTime, LocalizedText, NodeClass, NodeId, NumericRange, ObjectId, ObjectTypeId,
    QualifiedName, StatusCode, UAString, Variant,
};

use super::spaces::{CNC, NAMESPACE};
use crate::live::Seen;
use crate::machine::Machine;
use crate::variables::{Arrival, Describe, Parameter, RaisedAlarm, axis_name, place_name};

/// The number of `CncAlarmType` in it.
const CNC_ALARM_TYPE: u32 = 1006;
/// The types above `CncAlarmType`, from the base on.
const ANCESTORS: [ObjectTypeId; 5] = [
    ObjectTypeId::BaseEventType,
    ObjectTypeId::ConditionType,
    ObjectTypeId::AcknowledgeableConditionType,
    ObjectTypeId::AlarmConditionType,
    ObjectTypeId::DiscreteAlarmType,
];
/// From this number on, alarms are those of the PLC.
const FIRST_OF_PLC: u32 = 400_000;

/// All fields, by their paths. The library must know them: it drops those that it does not know from the answer, so that all that follow
/// move to wrong places.
const FIELDS: &[&str] = &[
    "EventId",
    "EventType",
    "SourceNode",
    "SourceName",
    "Time",
    "ReceiveTime",
    "LocalTime",
    "Message",
    "Severity",
    "ConditionClassId",
    "ConditionClassName",
    "ConditionSubClassId",
    "ConditionSubClassName",
    "ConditionName",
    "BranchId",
    "Retain",
    "SupportsFilteredRetain",
    "EnabledState",
    "EnabledState/Id",
    "Quality",
    "Quality/SourceTimestamp",
    "LastSeverity",
    "LastSeverity/SourceTimestamp",
    "Comment",
    "Comment/SourceTimestamp",
    "ClientUserId",
    "AckedState",
    "AckedState/Id",
    "ConfirmedState",
    "ConfirmedState/Id",
    "ActiveState",
    "ActiveState/Id",
    "ActiveState/EffectiveDisplayName",
    "InputNode",
    "SuppressedOrShelved",
    "SuppressedState",
    "SuppressedState/Id",
    "OutOfServiceState",
    "OutOfServiceState/Id",
    "MaxTimeShelved",
    "AlarmIdentifier",
    "AuxParameters",
    "HelpSource",
];

/// The fields of `CncAlarmType` itself.
const OF_CNC: [&str; 3] = ["AlarmIdentifier", "AuxParameters", "HelpSource"];

/// The type of our events.
pub(super) fn cnc_alarm_type() -> NodeId {
    NodeId::new(CNC, CNC_ALARM_TYPE)
}

/// Registers the type, and all fields at each of its ancestors: the library does not inherit them.
pub(super) fn register(type_tree: &mut DefaultTypeTree) {
    let parent = ObjectTypeId::DiscreteAlarmType.into();
    type_tree.add_type_node(&cnc_alarm_type(), &parent, NodeClass::ObjectType);
    let types = ANCESTORS.into_iter().map(NodeId::from).chain([cnc_alarm_type()]);
    for of in types {
        // The ConditionId: no path, and the attribute NodeId.
        type_tree.add_type_property(&of, &of, &[], NodeClass::Object);
        for field in FIELDS {
            let namespace = if OF_CNC.contains(field) { CNC } else { 0 };
            let path: Vec<_> = field.split('/').map(|name| QualifiedName::new(namespace, name)).collect();
            let id = NodeId::new(CNC, format!("{of}/{field}"));
            type_tree.add_type_property(&id, &of, &path.iter().collect::<Vec<_>>(), NodeClass::Variable);
        }
    }
}

/// An alarm that was raised or cleared, or is pending.
#[derive(Debug)]
pub(super) struct AlarmEvent {
    id: ByteString,
    kind: NodeId,
    condition: NodeId,
    source: &'static str,
    time: DateTime,
    text: String,
    number: String,
    parameters: Vec<String>,
    cause: String,
    severity: u16,
    is_pending: bool,
}

impl AlarmEvent {
    fn of(Known { alarm, cause, .. }: &Known, machine: &Machine, is_pending: bool, time: DateTime, id: u64) -> Self {
        let number = machine.alarm_name(alarm.number);
        let place = place_name(alarm.place, machine.names());
        let parameters = alarm.parameters.iter().filter_map(|parameter| text_of(parameter, machine));
        let reaction = machine.control().texts().alarm(alarm.number).map(|row| row.reaction).unwrap_or_default();
        let is_shown_only = reaction.split(", ").all(|word| matches!(word, "" | "shown" | "interface signals"));
        Self {
            id: ByteString::from(id.to_be_bytes().to_vec()),
            kind: cnc_alarm_type(),
            condition: NodeId::new(NAMESPACE, format!("/Alarm/{place}/{number}")),
            source: if alarm.number.0 >= FIRST_OF_PLC { "PLC" } else { "NCK" },
            time,
            text: machine.alarm_text(alarm),
            parameters: std::iter::once(place).chain(parameters).collect(),
            cause: cause.clone(),
            severity: if is_shown_only { 500 } else { 1000 },
            number,
            is_pending,
        }
    }

    fn field(&self, path: &str) -> Variant {
        let state = |name: &str| Variant::from(LocalizedText::new("en", name));
        match path {
            "EventId" => self.id.clone().into(),
            "EventType" => self.kind.clone().into(),
            "SourceNode" => NodeId::from(ObjectId::Server).into(),
            "SourceName" => self.source.into(),
            "Time" | "ReceiveTime" => self.time.into(),
            "Message" => LocalizedText::new("en", &self.text).into(),
            "Severity" => self.severity.into(),
            "ConditionClassId" => NodeId::from(ObjectTypeId::SystemConditionClassType).into(),
            "ConditionClassName" => LocalizedText::new("en", "SystemConditionClassType").into(),
            "ConditionName" => "SystemCondition".into(),
            "BranchId" | "InputNode" => NodeId::null().into(),
            "Retain" | "ActiveState/Id" => self.is_pending.into(),
            "EnabledState" => state("Enabled"),
            "EnabledState/Id" | "AckedState/Id" => true.into(),
            "AckedState" => state("Acknowledged"),
            "ActiveState" => state(if self.is_pending { "Active" } else { "Inactive" }),
            "SuppressedOrShelved" => false.into(),
            "Quality" => StatusCode::Good.into(),
            "LastSeverity" => 0_u16.into(),
            "Comment" => LocalizedText::null().into(),
            "ClientUserId" => UAString::null().into(),
            "AlarmIdentifier" => self.number.clone().into(),
            "AuxParameters" => self.parameters.clone().into(),
            "HelpSource" => LocalizedText::new("en", &self.cause).into(),
            _ => Variant::Empty,
        }
    }
}

fn text_of(parameter: &Parameter, machine: &Machine) -> Option<String> {
    Some(match *parameter {
        Parameter::None => return None,
        Parameter::Channel(number) => machine.names().channels[number].clone().unwrap_or_default(),
        Parameter::Axis(number) => axis_name(number, machine.names()),
        Parameter::Number(number) => number.to_string(),
        Parameter::Direction(direction) => if direction < 0 { "-" } else { "+" }.to_owned(),
        Parameter::Milliseconds(time) => time.milliseconds().to_string(),
        Parameter::Text(text) => text.to_string(),
        Parameter::OfControl(index) => machine.message_text(index).to_owned(),
    })
}

impl EventField for AlarmEvent {
    fn get_value(&self, attribute: AttributeId, _: &NumericRange, path: &[QualifiedName]) -> Variant {
        match (attribute, path) {
            (AttributeId::NodeId, []) => self.condition.clone().into(),
            (AttributeId::Value, [_, ..]) => {
                self.field(&path.iter().map(|name| name.name.as_ref()).collect::<Vec<_>>().join("/"))
            }
            _ => Variant::Empty,
        }
    }
}

impl Event for AlarmEvent {
    fn get_field(&self, _: &NodeId, attribute: AttributeId, range: &NumericRange, path: &[QualifiedName]) -> Variant {
        self.get_value(attribute, range, path)
    }

    fn time(&self) -> &DateTime {
        &self.time
    }

    fn event_type_id(&self) -> &NodeId {
        &self.kind
    }
}

/// A pending alarm.
#[derive(Clone, Debug)]
struct Known {
    alarm: RaisedAlarm,
    /// An alarm that was cleared and raised again has another one.
    ordinal: u32,
    cause: String,
}

/// The pending alarms, and the number of the last event.
#[derive(Debug, Default)]
pub(super) struct Alarms {
    known: Vec<Known>,
    /// The step up to which they are known.
    since: u64,
    last: u64,
}

fn pending(seen: &Seen) -> Vec<Known> {
    let alarms = seen.machine().variables().alarms.arrivals();
    let known = |(alarm, arrival): (&RaisedAlarm, Arrival)| Known {
        alarm: *alarm,
        ordinal: arrival.ordinal,
        cause: seen.cause(alarm).unwrap_or_default().to_owned(),
    };
    alarms.map(known).collect()
}

impl Alarms {
    /// What is pending is known from now on; only changes are reported.
    pub(super) fn begin(&mut self, seen: &Seen) {
        (self.known, self.since) = (pending(seen), seen.step());
    }

    /// What was cleared and raised in a step, in order of number and place.
    pub(super) fn changes(&mut self, seen: &Seen, instant: DateTime) -> Vec<AlarmEvent> {
        let is_same = self.known.iter().map(|known| (&known.alarm, known.ordinal)).eq(ordinals(seen));
        if is_same || seen.step() <= self.since {
            return Vec::new();
        }
        let (old, new) = (std::mem::take(&mut self.known), pending(seen));
        let is_in = |known: &Known, list: &[Known]| {
            list.iter().any(|other| (other.alarm, other.ordinal) == (known.alarm, known.ordinal))
        };
        let cleared = old.iter().filter(|known| !is_in(known, &new)).map(|known| (known, false));
        let raised = new.iter().filter(|known| !is_in(known, &old)).map(|known| (known, true));
        let events = cleared.chain(raised);
        let events =
            events.map(|(known, is)| AlarmEvent::of(known, seen.machine(), is, instant, self.next())).collect();
        self.known = new;
        events
    }

    fn next(&mut self) -> u64 {
        self.last += 1;
        self.last
    }

    /// Sends what is pending to the subscriptions, between the two events that mark it.
    pub(super) fn refresh(&mut self, seen: &Seen, subscriptions: &SubscriptionCache) {
        let now = DateTime::now();
        let mut mark = |kind: ObjectTypeId| {
            let id = ByteString::from(self.next().to_be_bytes().to_vec());
            let mut event = opcua::nodes::BaseEventType::new(kind, id, LocalizedText::null(), now);
            event.severity = 100;
            event.source_node = ObjectId::Server.into();
            event.source_name = "Server".into();
            Mark(event)
        };
        let (start, end) = (mark(ObjectTypeId::RefreshStartEventType), mark(ObjectTypeId::RefreshEndEventType));
        let known = pending(seen);
        let events: Vec<_> =
            known.iter().map(|known| AlarmEvent::of(known, seen.machine(), true, now, self.next())).collect();
        let server = NodeId::from(ObjectId::Server);
        let mut notifier = subscriptions.event_notifier();
        if let Some(mut items) = notifier.notify_for(&server) {
            items.event(&start);
            events.iter().for_each(|event| items.event(event));
            items.event(&end);
        }
    }
}

fn ordinals(seen: &Seen) -> impl Iterator<Item = (&RaisedAlarm, u32)> {
    seen.machine().variables().alarms.arrivals().map(|(alarm, arrival)| (alarm, arrival.ordinal))
}

/// Sends events to the subscriptions.
pub(super) fn send(events: &[AlarmEvent], subscriptions: &SubscriptionCache) {
    if events.is_empty() {
        return;
    }
    let server = NodeId::from(ObjectId::Server);
    let mut notifier = subscriptions.event_notifier();
    if let Some(mut items) = notifier.notify_for(&server) {
        events.iter().for_each(|event| items.event(event));
    }
}

/// The start or the end of a refresh: the fields of a plain event, whatever type a client names with them.
#[derive(Debug)]
struct Mark(opcua::nodes::BaseEventType);

impl EventField for Mark {
    fn get_value(&self, attribute: AttributeId, range: &NumericRange, path: &[QualifiedName]) -> Variant {
        self.0.get_value(attribute, range, path)
    }
}

impl Event for Mark {
    fn get_field(&self, _: &NodeId, attribute: AttributeId, range: &NumericRange, path: &[QualifiedName]) -> Variant {
        self.get_value(attribute, range, path)
    }

    fn time(&self) -> &DateTime {
        self.0.time()
    }

    fn event_type_id(&self) -> &NodeId {
        self.0.event_type_id()
    }
}
