//! The nodes of the namespace, for the server's library: reads, writes, browsing and subscriptions of all clients.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use async_trait::async_trait;
use opcua::nodes::{DefaultTypeTree, TypeTree};
use opcua::server::diagnostics::NamespaceMetadata;
use opcua::server::node_manager::{
    AddReferenceResult, BrowseNode, BrowsePathItem, ExternalReferenceRequest, MethodCall, MonitoredItemRef,
    NodeManager, NodeMetadata, ReadNode, RequestContext, ServerContext, WriteNode,
    impl_translate_browse_paths_using_browse,
};
use opcua::server::{CreateMonitoredItem, SubscriptionCache};
use opcua::types::{
    AttributeId, DataValue, ExpandedNodeId, Identifier, LocalizedText, MethodId, NodeClass, NodeId, NumericRange,
    ObjectId, ObjectTypeId, QualifiedName, ReferenceDescription, ReferenceTypeId, StatusCode, TimestampsToReturn,
    VariableTypeId, Variant, VariantScalarTypeId,
};

use super::alarms::{Alarms, register, send};
use super::attributes::{Found, attribute, find, names, space};
use super::options::OpcUaOptions;
use super::reading::{Reader, Terms, with_reader};
use super::rights::Rights;
use super::spaces::{CNC, CNC_URI, NAMESPACE, URI};
use super::tree::{Node, Tree};
use super::watching::Watching;
use crate::live::{Handle, Order};
use crate::machine::Command;

/// The machine, as the library sees it.
pub(super) struct Manager {
    live: Handle,
    tree: Tree,
    options: Arc<OpcUaOptions>,
    watching: Mutex<Watching>,
    alarms: Mutex<Alarms>,
    /// A client has come.
    has_begun: AtomicBool,
}

impl Manager {
    pub(super) fn new(live: Handle, options: Arc<OpcUaOptions>) -> Self {
        let terms = Terms { speed: 1.0, serial_number: &options.serial_number };
        let tree = live.look(|seen| with_reader(seen, terms, Tree::of));
        let watching = Mutex::new(Watching::new(live.clone(), options.serial_number.clone()));
        Self { tree, options, watching, alarms: Mutex::default(), has_begun: AtomicBool::new(false), live }
    }

    fn watching(&self) -> MutexGuard<'_, Watching> {
        self.watching.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn alarms(&self) -> MutexGuard<'_, Alarms> {
        self.alarms.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A client has come: it gets what changes from now on.
    pub(super) fn begin(&self) {
        if !self.has_begun.swap(true, Ordering::AcqRel) {
            self.watching().begin();
            let mut alarms = self.alarms();
            self.live.look(|seen| alarms.begin(seen));
        }
    }

    /// Reports what happened since the last call.
    pub(super) fn advance(&self, subscriptions: &SubscriptionCache) {
        let mut events = Vec::new();
        let mut alarms = self.alarms();
        self.watching().advance(subscriptions, |seen, instant| events.extend(alarms.changes(seen, instant)));
        send(&events, subscriptions);
    }

    fn with_reader<T>(&self, work: impl FnOnce(&Reader<'_>) -> T) -> T {
        let terms = Terms { speed: self.live.speed().ratio(), serial_number: &self.options.serial_number };
        self.live.look(|seen| with_reader(seen, terms, work))
    }

    /// The commands of one write, or why it is refused.
    fn commands(&self, write: &WriteNode, reader: &Reader<'_>, rights: Rights) -> Result<Vec<Command>, StatusCode> {
        let to = write.value();
        let found = text(&to.node_id).and_then(|text| find(&self.tree, text)).ok_or(StatusCode::BadNodeIdUnknown)?;
        let Found::Value(id, _) = found else { return Err(StatusCode::BadNotWritable) };
        if to.attribute_id != AttributeId::Value || to.index_range != NumericRange::None {
            return Err(StatusCode::BadWriteNotSupported);
        }
        if !rights.may_write(&id) {
            return Err(StatusCode::BadUserAccessDenied);
        }
        let value = to.value.value.as_ref().ok_or(StatusCode::BadTypeMismatch)?;
        let commands = reader.write(&id, value)?;
        let refuses = |command: &Command| (self.options.protects)(reader.machine(), command).is_some();
        if self.options.is_read_only || commands.iter().any(refuses) {
            return Err(StatusCode::BadUserAccessDenied);
        }
        if commands.iter().any(|command| reader.machine().check(command).is_err()) {
            return Err(StatusCode::BadOutOfRange);
        }
        Ok(commands)
    }

    fn metadata(&self, found: &Found<'_>, text: &str, reader: &Reader<'_>) -> NodeMetadata {
        let [browse_name, display_name, _] = names(found, text, reader);
        let is_folder = matches!(found, Found::Folder(_));
        NodeMetadata {
            node_id: NodeId::new(NAMESPACE, text.to_owned()).into(),
            type_definition: type_of(found).into(),
            browse_name: QualifiedName::new(space(found), browse_name),
            display_name: LocalizedText::new("", &display_name),
            node_class: if is_folder { NodeClass::Object } else { NodeClass::Variable },
        }
    }

    /// The references of a node of ours, or of the folder of all objects.
    fn references(&self, node: &BrowseNode, reader: &Reader<'_>) -> Option<VecDeque<ReferenceDescription>> {
        let mut all = VecDeque::new();
        let target = |text: &str| {
            let found = find(&self.tree, text)?;
            Some(self.metadata(&found, text, reader))
        };
        let mut add = |metadata: Option<NodeMetadata>, is_forward, kind: ReferenceTypeId| {
            all.extend(metadata.map(|metadata| metadata.into_ref_desc(is_forward, kind)));
        };
        let (forward, inverse) = (node.allows_forward(), node.allows_inverse());
        if *node.node_id() == ObjectId::ObjectsFolder {
            if forward {
                for root in self.tree.roots() {
                    add(target(&root.id), true, ReferenceTypeId::Organizes);
                }
            }
            return Some(all);
        }
        let found = find(&self.tree, text(node.node_id())?)?;
        let tree_node = match &found {
            Found::Folder(folder) => Some(*folder),
            Found::Value(_, node) => *node,
        };
        if let Some(tree_node) = tree_node {
            for child in tree_node.children.iter().filter(|_| forward) {
                add(target(&self.tree.node(*child).id), true, ReferenceTypeId::Organizes);
            }
            let parent = match tree_node.parent {
                Some(parent) => target(&self.tree.node(parent).id),
                None => Some(objects_folder()),
            };
            add(parent.filter(|_| inverse), false, ReferenceTypeId::Organizes);
        }
        add(Some(type_metadata(&found)).filter(|_| forward), true, ReferenceTypeId::HasTypeDefinition);
        Some(all)
    }
}

/// The text of an id of our namespace.
fn text(id: &NodeId) -> Option<&str> {
    match &id.identifier {
        Identifier::String(text) if id.namespace == NAMESPACE => Some(text.as_ref()),
        _ => None,
    }
}

/// The methods that show a client what is pending: name, and number of parameters. The library does not have them.
fn refresh(id: &NodeId) -> Option<(&'static str, usize)> {
    let is = |method: MethodId| *id == NodeId::from(method);
    if is(MethodId::ConditionType_ConditionRefresh) {
        Some(("ConditionRefresh", 1))
    } else if is(MethodId::ConditionType_ConditionRefresh2) {
        Some(("ConditionRefresh2", 2))
    } else {
        None
    }
}

/// An attribute of such a method.
fn of_method(id: &NodeId, name: &str, attribute: AttributeId) -> Option<Variant> {
    Some(match attribute {
        AttributeId::NodeId => id.clone().into(),
        AttributeId::NodeClass => (NodeClass::Method as i32).into(),
        AttributeId::BrowseName => QualifiedName::new(0, name).into(),
        AttributeId::DisplayName => LocalizedText::new("", name).into(),
        AttributeId::WriteMask | AttributeId::UserWriteMask => 0_u32.into(),
        AttributeId::Executable | AttributeId::UserExecutable => true.into(),
        _ => return None,
    })
}

/// The type of a node.
fn type_of(found: &Found<'_>) -> NodeId {
    match found {
        Found::Folder(Node { kind: Some(kind), .. }) => NodeId::new(CNC, *kind),
        Found::Folder(_) => ObjectTypeId::FolderType.into(),
        Found::Value(..) => VariableTypeId::BaseDataVariableType.into(),
    }
}

fn type_metadata(found: &Found<'_>) -> NodeMetadata {
    let (name, node_class) = match found {
        Found::Folder(Node { kind: Some(_), .. }) => ("CncType", NodeClass::ObjectType),
        Found::Folder(_) => ("FolderType", NodeClass::ObjectType),
        Found::Value(..) => ("BaseDataVariableType", NodeClass::VariableType),
    };
    NodeMetadata {
        node_id: type_of(found).into(),
        type_definition: ExpandedNodeId::null(),
        browse_name: QualifiedName::new(0, name),
        display_name: LocalizedText::new("", name),
        node_class,
    }
}

fn objects_folder() -> NodeMetadata {
    NodeMetadata {
        node_id: ObjectId::ObjectsFolder.into(),
        type_definition: ObjectTypeId::FolderType.into(),
        browse_name: QualifiedName::new(0, "Objects"),
        display_name: LocalizedText::new("", "Objects"),
        node_class: NodeClass::Object,
    }
}

/// References that did not fit into an answer.
struct Rest(VecDeque<ReferenceDescription>);

fn fill(node: &mut BrowseNode, type_tree: &dyn TypeTree, mut rest: VecDeque<ReferenceDescription>) {
    while let Some(reference) = rest.pop_front() {
        if let AddReferenceResult::Full(reference) = node.add(type_tree, reference) {
            rest.push_front(reference);
            node.set_next_continuation_point(Box::new(Rest(rest)));
            return;
        }
    }
}

#[expect(elided_lifetimes_in_paths, reason = "the trait of the library has its lifetimes so")]
#[async_trait]
impl NodeManager for Manager {
    fn owns_node(&self, id: &NodeId) -> bool {
        id.namespace == NAMESPACE || refresh(id).is_some()
    }

    fn name(&self) -> &str {
        URI
    }

    fn namespaces_for_user(&self, _: &RequestContext) -> Vec<NamespaceMetadata> {
        let space = |(namespace_index, uri): (u16, &str)| NamespaceMetadata {
            namespace_uri: uri.to_owned(),
            namespace_index,
            is_namespace_subset: Some(false),
            ..NamespaceMetadata::default()
        };
        [(NAMESPACE, URI), (CNC, CNC_URI)].map(space).into()
    }

    async fn init(&self, type_tree: &mut DefaultTypeTree, _: ServerContext) {
        register(type_tree);
    }

    async fn resolve_external_references(&self, _: &RequestContext, items: &mut [&mut ExternalReferenceRequest]) {
        self.with_reader(|reader| {
            for item in items {
                let id = item.node_id().clone();
                if let Some((text, found)) = text(&id).and_then(|text| Some((text, find(&self.tree, text)?))) {
                    item.set(self.metadata(&found, text, reader));
                }
            }
        });
    }

    async fn read(
        &self,
        context: &RequestContext,
        _: f64,
        _: TimestampsToReturn,
        nodes: &mut [&mut ReadNode],
    ) -> Result<(), StatusCode> {
        let rights = self.options.rights(&context.token.0);
        self.with_reader(|reader| {
            for node in nodes {
                let of = node.node().clone();
                if let Some((name, _)) = refresh(&of.node_id) {
                    match of_method(&of.node_id, name, of.attribute_id) {
                        Some(value) => node.set_result(DataValue::new_now(value)),
                        None => node.set_error(StatusCode::BadAttributeIdInvalid),
                    }
                    continue;
                }
                let Some((text, found)) = text(&of.node_id).and_then(|text| Some((text, find(&self.tree, text)?)))
                else {
                    node.set_error(StatusCode::BadNodeIdUnknown);
                    continue;
                };
                let (may_read, may_write) = match &found {
                    Found::Folder(_) => (true, false),
                    Found::Value(id, _) => (rights.may_read(id), rights.may_write(id) && !self.options.is_read_only),
                };
                if !may_read && of.attribute_id == AttributeId::Value {
                    node.set_error(StatusCode::BadUserAccessDenied);
                    continue;
                }
                let mut value = attribute(&found, text, of.attribute_id, reader, may_write);
                if of.index_range != NumericRange::None {
                    match value.value.take().map(|value| value.range_of(&of.index_range)) {
                        Some(Ok(range)) => value.value = Some(range),
                        Some(Err(status)) => value.status = Some(status),
                        None => {}
                    }
                }
                node.set_result(value);
            }
        });
        Ok(())
    }

    /// All of a request takes effect at the start of the same step, and is acknowledged when it is over.
    async fn write(&self, context: &RequestContext, nodes: &mut [&mut WriteNode]) -> Result<(), StatusCode> {
        let rights = self.options.rights(&context.token.0);
        let mut order = Order::default();
        self.with_reader(|reader| {
            for node in &mut *nodes {
                match self.commands(node, reader, rights) {
                    Ok(commands) => {
                        order.commands.extend(commands);
                        node.set_status(StatusCode::Good);
                    }
                    Err(status) => node.set_status(status),
                }
            }
        });
        if !order.is_empty() {
            let step = self.live.order(order);
            if !self.live.taken_up(step).await {
                return Err(StatusCode::BadServerHalted);
            }
        }
        Ok(())
    }

    async fn browse(&self, context: &RequestContext, nodes: &mut [BrowseNode]) -> Result<(), StatusCode> {
        let type_tree = context.get_type_tree_for_user();
        self.with_reader(|reader| {
            for node in nodes {
                if let Some(rest) = node.take_continuation_point::<Rest>() {
                    fill(node, type_tree.get(), rest.0);
                } else if let Some(references) = self.references(node, reader) {
                    if node.node_id().namespace == NAMESPACE {
                        node.set_status(StatusCode::Good);
                    }
                    fill(node, type_tree.get(), references);
                }
            }
        });
        Ok(())
    }

    async fn translate_browse_paths_to_node_ids(
        &self,
        context: &RequestContext,
        nodes: &mut [&mut BrowsePathItem],
    ) -> Result<(), StatusCode> {
        impl_translate_browse_paths_using_browse(self, context, nodes).await
    }

    async fn create_monitored_items(
        &self,
        context: &RequestContext,
        items: &mut [&mut CreateMonitoredItem],
    ) -> Result<(), StatusCode> {
        // The first value of an item and its edges continue each other: what happened before is reported first.
        self.advance(&context.subscriptions);
        let rights = self.options.rights(&context.token.0);
        let mut watching = self.watching();
        for item in items {
            let (of, handle) = (item.item_to_monitor().clone(), item.handle());
            let found = text(&of.node_id).and_then(|text| Some((text, find(&self.tree, text)?)));
            let first = match (found, of.attribute_id) {
                (None, _) => Err(StatusCode::BadNodeIdUnknown),
                (Some((_, Found::Value(id, _))), AttributeId::Value) if !rights.may_read(&id) => {
                    Err(StatusCode::BadUserAccessDenied)
                }
                (Some((text, Found::Value(id, _))), AttributeId::Value) => watching.add(handle, &of.node_id, text, &id),
                // The other attributes never change.
                (Some((text, found)), other) => {
                    let value = self.with_reader(|reader| attribute(&found, text, other, reader, true));
                    if value.status().is_bad() { Err(value.status()) } else { Ok(value) }
                }
            };
            match first {
                Ok(value) => {
                    item.set_initial_value(value);
                    item.set_status(StatusCode::Good);
                }
                Err(status) => item.set_status(status),
            }
        }
        Ok(())
    }

    async fn call(&self, context: &RequestContext, calls: &mut [&mut MethodCall]) -> Result<(), StatusCode> {
        for call in calls {
            let Some((_, parameters)) = refresh(call.method_id()) else {
                call.set_status(StatusCode::BadMethodInvalid);
                continue;
            };
            let subscription = call.arguments().first().map(|first| first.cast(VariantScalarTypeId::UInt32));
            let own = context.subscriptions.get_session_subscriptions(context.session_id());
            let has = |id| own.is_some_and(|own| own.lock().contains(id));
            call.set_status(match subscription {
                _ if call.arguments().len() < parameters => StatusCode::BadArgumentsMissing,
                _ if call.arguments().len() > parameters => StatusCode::BadTooManyArguments,
                Some(Variant::UInt32(id)) if has(id) => {
                    // What happened before the call is reported before its answer.
                    self.advance(&context.subscriptions);
                    let mut alarms = self.alarms();
                    self.live.look(|seen| alarms.refresh(seen, &context.subscriptions));
                    StatusCode::Good
                }
                Some(Variant::UInt32(_)) => StatusCode::BadSubscriptionIdInvalid,
                _ => StatusCode::BadInvalidArgument,
            });
        }
        Ok(())
    }

    async fn delete_monitored_items(&self, _: &RequestContext, items: &[&MonitoredItemRef]) {
        let mut watching = self.watching();
        for item in items {
            watching.remove(item.handle());
        }
    }
}
