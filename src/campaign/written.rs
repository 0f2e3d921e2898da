//! Writes the tree of a TOML file as text.

use crate::source::{Node, Table, Value};

/// A scenario as text: its keys, then its tables, then its steps.
pub(super) fn scenario(table: &Table) -> String {
    let mut text = String::new();
    let is_list = |node: &Node| matches!(&node.value, Value::Array(list) if !list.is_empty() && list.iter().all(|one| matches!(one.value, Value::Table(_))));
    let is_table = |node: &Node| matches!(node.value, Value::Table(_));
    for (key, node) in table.entries().filter(|(_, node)| !is_list(node) && !is_table(node)) {
        text += &format!("{} = {}\n", written_key(key), value(node));
    }
    for (key, node) in table.entries() {
        if let Value::Table(inner) = &node.value {
            text += &format!("\n[{}]\n{}", written_key(key), lines(inner));
        }
    }
    let mut lists: Vec<_> = table.entries().filter(|(_, node)| is_list(node)).collect();
    lists.sort_by_key(|(key, _)| *key == "step");
    for (key, node) in lists {
        if let Value::Array(list) = &node.value {
            for one in list {
                if let Value::Table(inner) = &one.value {
                    text += &format!("\n[[{}]]\n{}", written_key(key), lines(inner));
                }
            }
        }
    }
    text
}

fn lines(table: &Table) -> String {
    table.entries().map(|(key, node)| format!("{} = {}\n", written_key(key), value(node))).collect()
}

/// A value on one line.
pub(super) fn value(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => quoted(text),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::Boolean(value) => value.to_string(),
        Value::Array(list) => format!("[{}]", list.iter().map(value).collect::<Vec<_>>().join(", ")),
        Value::Table(table) => {
            let entries: Vec<_> =
                table.entries().map(|(key, node)| format!("{} = {}", written_key(key), value(node))).collect();
            if entries.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", entries.join(", ")) }
        }
    }
}

/// A value as a name for people: a text without quotes.
pub(super) fn plain(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => text.clone(),
        _ => value(node),
    }
}

fn written_key(key: &str) -> String {
    let is_plain = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if is_plain { key.to_owned() } else { quoted(key) }
}

fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            '\r' => quoted.push_str("\\r"),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
