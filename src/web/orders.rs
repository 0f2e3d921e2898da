//! The body of `POST /api/command`: one verb of a scenario that acts at once, or one word that drives the machine.

use std::sync::Arc;
use std::time::Duration;

use serde::Serialize;
use serde_json::Value as Json;
use tokio::time::{sleep, timeout};

use crate::live::{Handle, Order, Seen, Speed};
use crate::machine::{Command, Machine};
use crate::scenario::commands;
use crate::source::{Node, Place, Problem, Table, Value};

/// Why a command may not be executed, if it may not.
pub(super) type Protects = Arc<dyn Fn(&Machine, &Command) -> Option<String> + Send + Sync>;

/// The most bytes that one request may write; an order takes effect in one step.
const MOST: u32 = 2048;
/// The most single steps of one request.
const STEPS: u64 = 1_000_000;
/// The longest time after which single steps are answered; those that are left are taken later.
const LONGEST: Duration = Duration::from_secs(10);
/// How often a waiting request looks whether the last step is over.
const LOOK: Duration = Duration::from_millis(1);
/// The words that drive the machine.
const DRIVES: [&str; 4] = ["pause", "step", "speed", "go_back"];

/// The answer: when the request acts.
#[derive(Debug, Serialize)]
pub(super) struct Taken {
    cycle: u64,
    step: u64,
}

/// Why a request is not executed.
#[derive(Debug)]
pub(super) enum Refusal {
    /// It is wrong.
    Wrong(Problem),
    /// It is not allowed.
    Forbidden(String),
}

impl From<Problem> for Refusal {
    fn from(problem: Problem) -> Self {
        Self::Wrong(problem)
    }
}

/// Executes a request. `holds` is told the commands that are queued.
pub(super) async fn execute(
    live: &Handle,
    body: &[u8],
    protects: &Protects,
    holds: impl FnOnce(&[Command]),
) -> Result<Taken, Refusal> {
    let json: Json = serde_json::from_slice(body).map_err(|error| {
        Problem::new(format!("expected JSON: {error}"), "write {\"set\": {\"X.traversing_key_plus\": 1}}")
    })?;
    if let Some(driven) = drive(live, &json).await {
        driven?;
        return Ok(live.look(|seen| Taken { cycle: seen.machine().cycle(), step: seen.step() }));
    }
    let node = Node::from_json(&json, &Place::file("the request"))?;
    let Value::Table(table) = node.value else {
        let what = "expected an object with one verb, found something else";
        return Err(Problem::new(what, "write {\"set\": {\"X.traversing_key_plus\": 1}}").into());
    };
    order(live, table, protects, holds)
}

/// Queues the commands of a verb.
fn order(live: &Handle, table: Table, protects: &Protects, holds: impl FnOnce(&[Command])) -> Result<Taken, Refusal> {
    let commands = live.look(|seen| {
        let machine = seen.machine();
        let commands = commands(table, machine, &DRIVES)?;
        match commands.iter().find_map(|command| protects(machine, command)) {
            Some(reason) => Err(Refusal::Forbidden(reason)),
            None => Ok(commands),
        }
    })?;
    let bytes: u32 = commands.iter().map(|command| command.location().map_or(8, |location| location.bytes())).sum();
    if bytes > MOST {
        let what = format!("expected at most {MOST} bytes for one step, found {bytes}");
        return Err(Problem::new(what, "send several requests").into());
    }
    if live.is_crowded() {
        let what = "expected a machine with time for requests, found one with very many";
        return Err(Problem::new(what, "send them more slowly").into());
    }
    let step = live.order(Order { commands: commands.clone(), ..Order::default() });
    holds(&commands);
    Ok(live.look(|seen| {
        // The machine may have taken the step already.
        let cycle = (seen.machine().cycle() + step).saturating_sub(seen.step());
        Taken { cycle, step }
    }))
}

/// Executes a word that drives the machine; `None` if the request has none.
async fn drive(live: &Handle, json: &Json) -> Option<Result<(), Problem>> {
    let (word, value) = json.as_object().filter(|object| object.len() == 1)?.iter().next()?;
    let wrong = |expected: &str, cure: &str| {
        let what = format!("expected {expected} for `{word}`, found {value}");
        Some(Err(Problem::new(what, cure)))
    };
    match word.as_str() {
        "pause" => match value.as_bool() {
            Some(is_paused) => {
                live.pause(is_paused);
                rest(live).await;
            }
            None => return wrong("true or false", "write {\"pause\": true}"),
        },
        "step" => match value.as_u64() {
            Some(steps @ 1..=STEPS) => step(live, steps).await,
            Some(_) | None => return wrong("a number of cycles up to a million", "write {\"step\": 1}"),
        },
        "speed" => match value.as_f64().and_then(|speed| speed.to_string().parse::<Speed>().ok()) {
            Some(speed) => live.set_speed(speed),
            None => return wrong("a number from 0.001 to 1000", "write {\"speed\": 0.1}"),
        },
        "go_back" => match value.as_u64() {
            Some(_) if live.is_held() => {
                return wrong("a machine that has begun", "start the PLC process it waits for");
            }
            Some(cycle) => return Some(live.go_back(cycle).await),
            None => return wrong("the number of a cycle", "write {\"go_back\": 1500}"),
        },
        _ => return None,
    }
    Some(Ok(()))
}

/// Takes single steps, after those of earlier requests, and waits until they are over.
async fn step(live: &Handle, steps: u64) {
    live.step(0);
    rest(live).await;
    let last = live.look(Seen::step) + steps;
    live.step(steps);
    // A machine that is held takes its first step when its PLC has come. Another client can pause before the last step.
    if !live.is_held() && timeout(LONGEST, live.over(last)).await.is_ok() {
        rest(live).await;
    }
}

/// Waits until a machine that pauses has ended its last step: a request that follows finds it there.
async fn rest(live: &Handle) {
    let rests = async {
        while live.is_paused() && !live.is_at_rest() {
            sleep(LOOK).await;
        }
    };
    let _ = timeout(LONGEST, rests).await;
}
