//! The main objects of OPC 40502 (CNC systems) over the values of the machine: the interface, its axes and its channels. The ids are ours, as
//! `CncInterface/CncAxisList/X/IsReferenced`; types and names of members are those of the specification. Members of which the machine has no
//! value are `BadNotSupported`: a 0 would be invented.

use opcua::types::{StatusCode, Variant};

use super::member::{Member, OF_AXIS, OF_CHANNEL, OF_INTERFACE, ROOT};
use super::node_id::Id;
use super::reading::{NOT_HERE, Reader};
use super::tree::{Described, Tree};
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::Describe;

/// The numbers of the types.
mod kind {
    pub(super) const CHANNEL: u32 = 1002;
    pub(super) const AXIS: u32 = 1004;
    pub(super) const INTERFACE: u32 = 1007;
}

impl Reader<'_> {
    /// The value of a member.
    pub(super) fn cnc(&self, of: &Member) -> Result<Variant, StatusCode> {
        let reader = self;
        match of {
            Member::Interface("Version") => Ok("1.00".into()),
            Member::Interface("VendorRevision") => Ok(env!("CARGO_PKG_VERSION").into()),
            Member::Interface(_) => Ok("OpenNCK".into()),
            Member::Axis(name, member) => axis(reader.machine().axis(name).ok_or(NOT_HERE)?, member, reader),
            Member::Channel(name, member) => {
                channel(reader.machine().names().channel(name).ok_or(NOT_HERE)?, member, reader)
            }
        }
    }
}

/// The value of an id of our namespace.
fn value(reader: &Reader<'_>, id: &str) -> Result<Variant, StatusCode> {
    reader.read(&Id::parse(id).ok_or(StatusCode::BadNotSupported)?)
}

fn is_on(reader: &Reader<'_>, number: AxisNumber, signal: &str) -> Result<bool, StatusCode> {
    let name = reader.machine().names().axes[number].clone().unwrap_or_default();
    let memory = reader.machine().memory();
    let location = reader.machine().names().resolve(memory, &format!("{name}.{signal}"));
    location.map(|location| memory.read(location) == 1).map_err(|_| StatusCode::BadNotSupported)
}

fn axis(number: AxisNumber, member: &str, reader: &Reader<'_>) -> Result<Variant, StatusCode> {
    let on = |signal| is_on(reader, number, signal);
    let values = &reader.machine().variables().axes[number];
    let is_parked = || -> Result<bool, StatusCode> {
        Ok(!on("position_measuring_system_1_activated")? && !on("position_measuring_system_2_activated")?)
    };
    Ok(match member {
        // CncAxisStatus: 0 in position, 1 moving, 2 parked.
        "ActStatus" => match (is_parked()?, on("axis_stationary")?) {
            (true, _) => 2.into(),
            (false, true) => 0.into(),
            (false, false) => 1.into(),
        },
        "IsReferenced" => (on("referenced_synchronized_1")? || on("referenced_synchronized_2")?).into(),
        "IsRotational" => reader.machine().is_rotary(number).into(),
        "IsInactive" => is_parked()?.into(),
        // The direct measuring system is the second one.
        "PosDirect/ActPos" => values.encoders[1].user().into(),
        "PosIndirect/ActPos" => values.encoders[0].user().into(),
        "PosDirect/CmdPos" | "PosIndirect/CmdPos" => values.setpoint.user().into(),
        "PosDirect/RemDist" | "PosIndirect/RemDist" => values.distance_to_go.user().into(),
        _ => return Err(StatusCode::BadNotSupported),
    })
}

fn channel(number: ChannelNumber, member: &str, reader: &Reader<'_>) -> Result<Variant, StatusCode> {
    let unit = number.number();
    let of = |path: &str| value(reader, &format!("/Channel/{path}[u{unit},1]"));
    let mapped = |value: Result<Variant, StatusCode>, to: &[i32]| match value? {
        Variant::UInt32(state) => usize::try_from(state)
            .ok()
            .and_then(|state| to.get(state))
            .map_or(Err(StatusCode::BadNotSupported), |state| Ok(Variant::from(*state))),
        _ => Err(StatusCode::BadNotSupported),
    };
    match member {
        "Id" => Ok(u32::from(unit).into()),
        // Ours: 0 reset, 1 active, 2 interrupted. Theirs: 0 active, 1 interrupted, 2 reset.
        "ActStatus" => mapped(of("State/chanStatus"), &[2, 0, 1]),
        // Ours: 1 interrupted, 2 stopped, 3 running, 4 waiting, 5 aborted. Theirs: 0 stopped, 1 running, 2 waiting, 3 interrupted, 4 canceled.
        "ActProgramStatus" => mapped(of("State/progStatus"), &[4, 3, 0, 1, 2, 4]),
        // Both: 0 manual, 1 MDA, 2 automatic.
        "ActOperationMode" => mapped(value(reader, "/Bag/State/opMode"), &[0, 1, 2]),
        "ActOverride" => of("State/feedRateIpoOvr"),
        _ => Err(StatusCode::BadNotSupported),
    }
}

impl Tree {
    /// Adds the objects to the tree.
    pub(super) fn add_cnc(&mut self, reader: &Reader<'_>) {
        let tree = self;
        let machine = reader.machine();
        let root = tree.add_described(None, ROOT, Described::object(ROOT, kind::INTERFACE));
        for member in OF_INTERFACE {
            tree.add_described(Some(root), &format!("{ROOT}/{member}"), Described::variable(member));
        }
        let axes = tree.add_described(Some(root), &format!("{ROOT}/CncAxisList"), Described::folder("CncAxisList"));
        for name in machine.names().axes.iter().filter_map(|(_, name)| name.clone()) {
            let id = format!("{ROOT}/CncAxisList/{name}");
            let axis = tree.add_described(Some(axes), &id, Described::object(&name, kind::AXIS));
            add_members(tree, axis, &id, &OF_AXIS);
        }
        let channels =
            tree.add_described(Some(root), &format!("{ROOT}/CncChannelList"), Described::folder("CncChannelList"));
        for number in ChannelNumber::all().filter(|number| machine.has_channel(*number)) {
            let Some(name) = machine.names().channels[number].clone() else { continue };
            let id = format!("{ROOT}/CncChannelList/{name}");
            let channel = tree.add_described(Some(channels), &id, Described::object(&name, kind::CHANNEL));
            add_members(tree, channel, &id, &OF_CHANNEL);
        }
        tree.add_described(Some(root), &format!("{ROOT}/CncSpindleList"), Described::folder("CncSpindleList"));
    }
}

fn add_members(tree: &mut Tree, of: usize, id: &str, members: &[&str]) {
    for member in members {
        let parent = match member.split_once('/') {
            Some((group, _)) => tree.add_described(Some(of), &format!("{id}/{group}"), Described::folder(group)),
            None => of,
        };
        let name = member.rsplit('/').next().unwrap_or_default();
        tree.add_described(Some(parent), &format!("{id}/{member}"), Described::variable(name));
    }
}
