//! `docs/openapi.json` and the server: the same paths and verbs, examples that the server takes, answers of the form that it describes.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeSet;

use serde_json::{Value, json};

use super::web::{Events, Page};

/// The document as the server gives it.
fn document(page: &Page) -> Value {
    let text = page.get("/api/openapi.json");
    assert_eq!(text, std::fs::read_to_string("docs/openapi.json").unwrap());
    serde_json::from_str(&text).unwrap()
}

fn schema<'a>(document: &'a Value, name: &str) -> &'a Value {
    &document["components"]["schemas"][name]
}

fn keys(object: &Value) -> BTreeSet<String> {
    object.as_object().unwrap().keys().cloned().collect()
}

/// How a value differs from a schema, if it does.
fn difference(document: &Value, schema: &Value, value: &Value, place: &str) -> Option<String> {
    if let Some(reference) = schema["$ref"].as_str() {
        let schema = document.pointer(reference.strip_prefix('#').unwrap()).unwrap();
        return difference(document, schema, value, place);
    }
    let is = |kind: &str| match kind {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "string" => value.is_string(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "array" => value.is_array(),
        _ => value.is_object(),
    };
    let kinds: Vec<&str> = match &schema["type"] {
        Value::String(kind) => vec![kind],
        kinds => kinds.as_array().into_iter().flatten().filter_map(Value::as_str).collect(),
    };
    if !kinds.is_empty() && !kinds.iter().any(|kind| is(kind)) {
        return Some(format!("{place}: expected {kinds:?}, found {value}"));
    }
    let choices = schema["enum"].as_array();
    if choices.is_some_and(|choices| !choices.contains(value)) || schema.get("const").is_some_and(|one| one != value) {
        return Some(format!("{place}: {value} is not among the values"));
    }
    let required = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let missing = value.as_object().and_then(|object| required.into_iter().find(|key| !object.contains_key(*key)));
    if let Some(missing) = missing {
        return Some(format!("{place}: {missing} is missing"));
    }
    let of_key = |(key, value): (&String, &Value)| match schema["properties"].get(key) {
        Some(schema) => difference(document, schema, value, &format!("{place}.{key}")),
        None => match &schema["additionalProperties"] {
            Value::Bool(false) => Some(format!("{place}: {key} is not described")),
            schema @ Value::Object(_) => difference(document, schema, value, &format!("{place}.{key}")),
            _ => None,
        },
    };
    let of_item = |item: &Value| difference(document, &schema["items"], item, &format!("{place}[]"));
    let below = value.as_object().and_then(|object| object.iter().find_map(of_key));
    below.or_else(|| value.as_array().and_then(|array| array.iter().find_map(of_item)))
}

#[track_caller]
fn conforms(document: &Value, name: &str, value: &Value) {
    let found = difference(document, schema(document, name), value, name);
    assert!(found.is_none(), "{}", found.unwrap_or_default());
}

/// The paths of the server with their methods, from its source.
fn routes() -> BTreeSet<(String, String)> {
    let source = std::fs::read_to_string("src/web/routes.rs").unwrap();
    let rows = source.split(".route(\"").skip(1);
    rows.map(|row| {
        let (path, rest) = row.split_once("\", ").unwrap();
        (path.to_owned(), rest.split('(').next().unwrap().to_owned())
    })
    .collect()
}

#[test]
fn the_document_has_every_path_and_every_verb() {
    let page = Page::open(|_| {});
    let document = document(&page);
    let paths = document["paths"].as_object().unwrap();
    let described =
        paths.iter().flat_map(|(path, methods)| keys(methods).into_iter().map(|method| (path.clone(), method)));
    assert_eq!(described.collect::<BTreeSet<_>>(), routes());
    // A wrong verb is answered with all of them.
    let (_, answer) = page.post(&json!({"no_verb_at_all": 1}), "");
    let listed = answer["cure"].as_str().unwrap().strip_prefix("verbs are ").unwrap();
    let mut verbs: BTreeSet<String> = listed.split(", ").map(str::to_owned).collect();
    assert!(verbs.len() > 20, "{verbs:?}");
    let content = &document["paths"]["/api/command"]["post"]["requestBody"]["content"]["application/json"];
    let examples = content["examples"].as_object().unwrap();
    let shown = examples.values().flat_map(|example| keys(&example["value"])).filter(|key| key != "channel");
    assert_eq!(shown.collect::<BTreeSet<_>>(), verbs, "each verb has an example");
    verbs.insert("channel".to_owned());
    assert_eq!(keys(&schema(&document, "Command")["properties"]), verbs);
}

#[test]
fn the_server_takes_every_example() {
    let document = document(&Page::open(|_| {}));
    let content = &document["paths"]["/api/command"]["post"]["requestBody"]["content"]["application/json"];
    for (name, example) in content["examples"].as_object().unwrap() {
        let machine = example["x-opennck-machine"].as_str();
        let page = machine.map_or_else(|| Page::open(|_| {}), |machine| Page::open_machine(machine, None, |_| {}));
        page.step_to(1000);
        conforms(&document, "Command", &example["value"]);
        let (status, answer) = page.post(&example["value"], "");
        assert_eq!(status, 200, "{name}: {answer}");
        conforms(&document, "Taken", &answer);
    }
}

#[test]
fn the_server_answers_as_the_document_says() {
    let page = Page::open(|_| {});
    let document = document(&page);
    let read = |path: &str| serde_json::from_str::<Value>(&page.get(path)).unwrap();
    page.step_to(500);
    let mut events = Events::open(&page);
    conforms(&document, "Snapshot", &events.next().1);
    page.command(&json!({"fault": {"axis": "X", "kind": "drive_fault"}}));
    page.command(&json!({"step": 20}));
    while events.next().1["now"]["alarms"].as_array().unwrap().is_empty() {}
    let (name, step) = events.next();
    assert_eq!(name, "step");
    conforms(&document, "StepEvent", &step);
    conforms(&document, "Catalogue", &read("/api/catalogue"));
    let state = read("/api/state");
    conforms(&document, "Snapshot", &state);
    assert!(!state["now"]["alarms"].as_array().unwrap().is_empty() && !state["recent"].as_array().unwrap().is_empty());
    conforms(&document, "Condition", &read("/api/why?signal=X.position_controller_active&value=1"));
    let (status, answer) = page.post(&json!({"set": {"X.nothing": 1}}), "");
    assert_eq!(status, 400);
    conforms(&document, "Error", &answer);
}

/// The page shows commands for curl: the server takes what they send.
#[test]
fn the_server_takes_the_commands_of_the_page() {
    let text = std::fs::read_to_string("docs/live_page.md").unwrap();
    let page = Page::open(|_| {});
    page.step_to(1000);
    let mut count = 0;
    for line in text.lines().filter(|line| line.starts_with("curl ")) {
        let (_, rest) = line.split_once("http://127.0.0.1:8080").unwrap();
        let path = rest.split(['\'', ' ']).next().unwrap();
        let data = line.split_once(" -d '").map(|(_, data)| data.split('\'').next().unwrap());
        let (method, headers) = match data {
            Some(_) if line.contains("-H 'Content-Type: application/json'") => {
                ("POST", "Content-Type: application/json\r\n")
            }
            Some(_) => panic!("{line}: the type is missing"),
            None => ("GET", ""),
        };
        let (status, _, answer) = page.ask(method, path, headers, data.unwrap_or_default());
        assert_eq!(status, 200, "{line}: {answer}");
        count += 1;
    }
    assert!(count >= 4, "{count} commands");
}

#[test]
fn a_value_of_another_form_is_found() {
    let document = json!({"components": {"schemas": {"A": {
        "type": "object", "required": ["b"], "additionalProperties": false,
        "properties": {"b": {"type": ["integer", "null"]}, "c": {"type": "array", "items": {"enum": [1, 2]}}},
    }}}});
    let found = |value: &Value| difference(&document, schema(&document, "A"), value, "A");
    assert_eq!(found(&json!({"b": null, "c": [1, 2]})), None);
    for (value, said) in [
        (json!([]), "expected"),
        (json!({}), "b is missing"),
        (json!({"b": 1.5}), "A.b: expected"),
        (json!({"b": 1, "c": [3]}), "A.c[]"),
        (json!({"b": 1, "d": 1}), "d is not described"),
    ] {
        assert!(found(&value).is_some_and(|found| found.contains(said)), "{value}");
    }
}
