//! The nodes that browsing shows: signals of the axes, channels and mode groups that exist, the blocks of the PLC program as patterns, NC
//! variables with all their axes and channels. Many more ids can be typed.

use std::collections::BTreeMap;

use super::node_id::{Own, Scope};
use super::reading::Reader;
use super::spaces::{CNC, NAMESPACE};
use crate::image::{Address, Block, Width};
use crate::machine::Machine;
use crate::units::{ChannelNumber, ModeGroupNumber};
use crate::variables::nc::{self, CATALOGUE, NckArea, Variable, View, module};

/// The root folder of a SINUMERIK.
pub(super) const ROOT: &str = "Sinumerik";

/// A node of the tree.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) id: String,
    /// The last part of the id. It has no slash: some clients take slashes as separators of paths.
    pub(super) browse_name: String,
    pub(super) display_name: String,
    pub(super) description: String,
    /// The namespace of the browse name.
    pub(super) space: u16,
    /// The number of its type in the namespace of OPC 40502, if it has one of those.
    pub(super) kind: Option<u32>,
    pub(super) is_folder: bool,
    pub(super) parent: Option<usize>,
    pub(super) children: Vec<usize>,
}

/// A node of OPC 40502.
#[derive(Clone, Copy, Debug)]
pub(super) struct Described<'a> {
    name: &'a str,
    is_folder: bool,
    kind: Option<u32>,
}

impl<'a> Described<'a> {
    pub(super) fn object(name: &'a str, kind: u32) -> Self {
        Self { name, is_folder: true, kind: Some(kind) }
    }

    pub(super) fn folder(name: &'a str) -> Self {
        Self { name, is_folder: true, kind: None }
    }

    pub(super) fn variable(name: &'a str) -> Self {
        Self { name, is_folder: false, kind: None }
    }
}

/// All nodes; the first one is the folder of the SINUMERIK.
#[derive(Debug)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    by_id: BTreeMap<String, usize>,
}

impl Tree {
    pub(super) fn of(reader: &Reader<'_>) -> Self {
        let mut tree = Self { nodes: Vec::new(), by_id: BTreeMap::new() };
        tree.add(None, ROOT, ROOT, ROOT.to_owned(), "The machine.".to_owned(), true);
        let plc = tree.folder(0, "/Plc", "Plc", "Memory of the PLC, by STEP 7 addresses.");
        tree.add_signals(plc, reader.machine());
        tree.add_patterns(plc, reader.machine());
        if nc::is_sinumerik(reader.view()) {
            tree.add_variables(reader.view(), reader.machine());
            let data = tree.folder(0, "/NC", "TEA", "Machine data, by typed ids: /NC/_N_AX_TEA_ACX/$MA_...[u1].");
            for scope in Scope::ALL {
                let (name, prefix) = scope.names();
                tree.folder(data, &format!("/NC/{name}"), name, &format!("Machine data {prefix}..."));
            }
        }
        let own = tree.folder(0, "/OpenNCK", "OpenNCK", "The simulator.");
        for (_, name, meaning) in Own::ALL {
            tree.add(Some(own), &format!("/OpenNCK/{name}"), name, name.to_owned(), meaning.to_owned(), false);
        }
        tree.add_cnc(reader);
        tree
    }

    /// The nodes in the folder of all objects.
    pub(super) fn roots(&self) -> impl Iterator<Item = &Node> {
        self.nodes.iter().filter(|node| node.parent.is_none())
    }

    pub(super) fn node(&self, index: usize) -> &Node {
        &self.nodes[index]
    }

    pub(super) fn find(&self, id: &str) -> Option<&Node> {
        self.by_id.get(id).map(|index| &self.nodes[*index])
    }

    #[cfg(test)]
    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Adds a node unless it is there, and returns its index.
    fn add(
        &mut self,
        parent: Option<usize>,
        id: &str,
        browse_name: &str,
        display_name: String,
        description: String,
        is_folder: bool,
    ) -> usize {
        if let Some(index) = self.by_id.get(id) {
            return *index;
        }
        let index = self.nodes.len();
        let (id, browse_name) = (id.to_owned(), browse_name.to_owned());
        self.by_id.insert(id.clone(), index);
        let children = Vec::new();
        let (space, kind) = (NAMESPACE, None);
        self.nodes.push(Node { id, browse_name, display_name, description, space, kind, is_folder, parent, children });
        if let Some(parent) = parent {
            self.nodes[parent].children.push(index);
        }
        index
    }

    /// Adds a node of OPC 40502.
    pub(super) fn add_described(&mut self, parent: Option<usize>, id: &str, of: Described<'_>) -> usize {
        let index = self.add(parent, id, of.name, of.name.to_owned(), String::new(), of.is_folder);
        (self.nodes[index].space, self.nodes[index].kind) = (CNC, of.kind);
        index
    }

    fn folder(&mut self, parent: usize, id: &str, name: &str, description: &str) -> usize {
        self.add(Some(parent), id, name, name.to_owned(), description.to_owned(), true)
    }

    fn add_signals(&mut self, plc: usize, machine: &Machine) {
        let names = machine.names();
        for (owner, block, number) in names.owners().filter(|(_, block, number)| exists(machine, *block, *number)) {
            for signal in names.interface().signals().filter(|signal| signal.block == block) {
                let Some(location) = names.interface().location(signal, number) else { continue };
                let address = names.address(location);
                // The profile may not show it.
                if machine.memory().locate(&address, names.profile).is_err() {
                    continue;
                }
                // STEP 7 has no notation for some bits of a byte: clients read the byte.
                let address = match address.width {
                    Width::Bits { .. } => Address { width: Width::Byte, ..address },
                    _ => address,
                };
                let block_name = address.area.to_string();
                let display = format!("{block_name} {owner}");
                let folder =
                    self.add(Some(plc), &format!("/Plc/{block_name}"), &block_name, display, String::new(), true);
                let text = address.to_string();
                let short = text.rsplit_once(".DB").map_or_else(|| text.clone(), |(_, short)| format!("DB{short}"));
                let symbol = names.symbol(location).unwrap_or_default();
                let description = format!("{symbol}: {}", signal.doc.trim());
                let display = format!("{short} {}", signal.name);
                self.add(Some(folder), &format!("/Plc/{text}"), &text, display, description, false);
            }
        }
    }

    fn add_patterns(&mut self, plc: usize, machine: &Machine) {
        for block in machine.memory().blocks.iter() {
            let name = format!("DB{}", block.number);
            let display = block.name.as_ref().map_or_else(|| name.clone(), |title| format!("{name} {title}"));
            let folder = self.add(Some(plc), &format!("/Plc/{name}"), &name, display, String::new(), true);
            for kind in ["DBX", "DBB", "DBW", "DBD"] {
                let text = format!("{name}.{kind}");
                self.add(
                    Some(folder),
                    &format!("/Plc/{text}"),
                    &text,
                    text.clone(),
                    "Add a number to read it.".to_owned(),
                    false,
                );
            }
        }
        for text in ["M", "MB", "MW", "MD", "IB", "IW", "ID", "QB", "QW", "QD", "T", "C"] {
            let meaning = "Add a number to read it.".to_owned();
            self.add(Some(plc), &format!("/Plc/{text}"), text, text.to_owned(), meaning, false);
        }
    }

    fn add_variables(&mut self, view: &View<'_>, machine: &Machine) {
        for variable in CATALOGUE {
            let Some([area, group, name]) = variable.path() else { continue };
            for (unit, line) in rows(variable, view, machine) {
                let top = self.folder(0, &format!("/{area}"), area, "");
                let folder = self.folder(top, &format!("/{area}/{group}"), group, "");
                // R is what clients write; its index is the number.
                let is_r = variable.module == module::RP;
                let name = if is_r { "R" } else { name };
                let index = if (unit, line) == (1, 1) { String::new() } else { format!("[u{unit},{line}]") };
                let shown = format!("{name}{index}");
                let of_axis = is_of_axis(variable);
                let display = match axis(line, view).filter(|_| of_axis) {
                    Some(axis) => format!("{name} {axis}"),
                    None => shown.clone(),
                };
                let description = format!("NC variable {}.", variable.name);
                self.add(Some(folder), &format!("/{area}/{group}/{shown}"), &shown, display, description, false);
            }
        }
    }
}

fn exists(machine: &Machine, block: Block, number: u8) -> bool {
    match block {
        Block::Channel => ChannelNumber::new(number).is_some_and(|channel| machine.has_channel(channel)),
        Block::ModeGroup => ModeGroupNumber::new(number).is_some_and(|group| machine.has_mode_group(group)),
        Block::Nck | Block::Axis => true,
    }
}

const fn is_of_axis(variable: &Variable) -> bool {
    matches!(variable.module, module::SMA | module::SEMA | module::SGA | module::SEGA)
}

fn axis<'a>(line: u16, view: &View<'a>) -> Option<&'a str> {
    let number = crate::units::AxisNumber::new(u8::try_from(line).ok()?)?;
    view.names.axes[number].as_deref()
}

/// The units and lines that browsing shows: all axes, channels and mode groups, and of other tables the first row.
fn rows(variable: &Variable, view: &View<'_>, machine: &Machine) -> Vec<(u8, u16)> {
    let units: Vec<u8> = match variable.area {
        NckArea::Channel => {
            let channels = ChannelNumber::all().filter(|channel| machine.has_channel(*channel));
            channels.map(|channel| channel.number()).collect()
        }
        NckArea::ModeGroup => {
            let groups = ModeGroupNumber::all().filter(|group| machine.has_mode_group(*group));
            groups.map(|group| group.number()).collect()
        }
        NckArea::Nck | NckArea::Axis | NckArea::FeedDrive => vec![1],
    };
    let last = if is_of_axis(variable) { view.names.interface().count(Block::Axis) } else { 1 };
    let exists = |unit, line| variable.value(view, unit, line, false).is_some();
    let lines = |unit| (1..=u16::from(last)).map(move |line| (unit, line));
    units.into_iter().flat_map(lines).filter(|(unit, line)| exists(*unit, *line)).collect()
}
