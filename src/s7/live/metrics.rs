//! Metrics for Prometheus: `GET /metrics` as text (exposition format 0.0.4) over a minimal HTTP server.
//!
//! Counters end in `_total`, times are in seconds. Prometheus computes the rates: the real speed is
//! `rate(opennck_simulated_seconds_total[1m])`, requests per second are `rate(opennck_s7_answers_total[1m])`.

use std::collections::{BTreeMap, VecDeque};
use std::fmt::{Display, Write};
use std::io;
use std::sync::Arc;
use std::time::Duration;

use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::{AbortHandle, JoinSet};
use tokio::time::{sleep, timeout};

use crate::live::Handle;
use crate::s7::server::{Counters, Network, Refused};
use crate::variables::Describe;

/// The longest request.
const LONGEST: usize = 8192;
/// Time limit for a request and its answer.
const TIME_LIMIT: Duration = Duration::from_secs(2);
/// Maximum number of simultaneous requests.
const PLACES: usize = 16;

/// Answers requests until it is dropped. At the limit the oldest request is dropped: a scrape takes milliseconds, and idle connections must
/// not block it.
pub(super) async fn serve(
    listener: TcpListener,
    networks: Vec<Network>,
    text: impl Fn() -> String + Send + Sync + 'static,
) {
    let text = Arc::new(text);
    let (mut tasks, mut places) = (JoinSet::new(), VecDeque::<AbortHandle>::new());
    loop {
        let Ok((mut stream, peer)) = listener.accept().await else {
            sleep(Duration::from_millis(50)).await;
            continue;
        };
        if !networks.is_empty() && !networks.iter().any(|network| network.contains(peer.ip())) {
            continue; // as for S7 clients; the connection closes without an answer
        }
        while tasks.try_join_next().is_some() {}
        places.retain(|place| !place.is_finished());
        if places.len() >= PLACES
            && let Some(oldest) = places.pop_front()
        {
            oldest.abort();
        }
        let text = Arc::clone(&text);
        places.push_back(tasks.spawn(async move {
            // A request that is too slow or disconnects gets no answer.
            let _ = timeout(TIME_LIMIT, answer(&mut stream, &*text)).await;
        }));
    }
}

async fn answer(stream: &mut TcpStream, text: &(impl Fn() -> String + Sync)) -> io::Result<()> {
    let mut request = Vec::with_capacity(1024);
    let answer = loop {
        if let Some(answer) = answer_to(&request, text) {
            break answer;
        }
        if stream.read_buf(&mut request).await? == 0 {
            return Ok(());
        }
    };
    stream.write_all(answer.as_bytes()).await?;
    stream.shutdown().await
}

/// The answer to a request; `None` while the request is incomplete.
fn answer_to(request: &[u8], text: impl Fn() -> String) -> Option<String> {
    let mut headers = [httparse::EMPTY_HEADER; 64];
    let mut parsed = httparse::Request::new(&mut headers);
    let kind = "text/plain; charset=utf-8";
    let (status, kind, body) = match parsed.parse(request) {
        Ok(httparse::Status::Partial) if request.len() < LONGEST => return None,
        Ok(httparse::Status::Partial) => ("431 Request Header Fields Too Large", kind, String::new()),
        Err(_) => ("400 Bad Request", kind, String::new()),
        Ok(httparse::Status::Complete(_)) => match (parsed.method, parsed.path.map(path)) {
            (Some("GET" | "HEAD"), Some("/metrics")) => ("200 OK", "text/plain; version=0.0.4; charset=utf-8", text()),
            (Some("GET" | "HEAD"), _) => ("404 Not Found", kind, "The metrics are at /metrics.\n".to_owned()),
            _ => ("405 Method Not Allowed\r\nAllow: GET, HEAD", kind, String::new()),
        },
    };
    let length = body.len();
    let body = if parsed.method == Some("HEAD") { "" } else { &body };
    Some(format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n{body}"
    ))
}

/// The target without its query.
fn path(target: &str) -> &str {
    // A request through a proxy has a complete URL.
    let path = target.strip_prefix("http://").and_then(|rest| rest.find('/').map(|at| &rest[at..])).unwrap_or(target);
    path.split_once('?').map_or(path, |(path, _)| path)
}

/// The current values of all metrics.
pub(super) fn text(live: &Handle, clients: usize, counters: &Counters) -> String {
    let mut text = Text(String::new());
    let pace = live.pace();
    let (steps, seconds, runs, alarms) = live.look(|seen| {
        let machine = seen.machine();
        let mut alarms = BTreeMap::<_, u64>::new();
        for alarm in machine.variables().alarms.iter() {
            *alarms.entry(machine.alarm_name(alarm.number)).or_default() += 1;
        }
        (machine.cycle(), machine.time().seconds(), !machine.is_plc_stopped(), alarms)
    });
    text.one("opennck_steps_total", "Steps of the machine, one per cycle.", steps);
    text.one("opennck_simulated_seconds_total", "Simulated time of the machine.", seconds);
    text.one("opennck_speed", "Requested speed relative to real time.", live.speed());
    text.one("opennck_overruns_total", "Steps that began after the next one was already due.", pace.overruns);
    text.one("opennck_worst_lateness_seconds", "Largest delay of a step.", pace.worst.as_secs_f64());
    text.one("opennck_lost_seconds_total", "Real time that was skipped.", pace.lost.as_secs_f64());
    text.one("opennck_plc_running", "1 if the PLC is in RUN.", u8::from(runs));
    text.family("opennck_alarms_pending", "Pending alarms, by number.");
    for (number, count) in alarms {
        text.sample("opennck_alarms_pending", &[("number", &number)], count);
    }
    text.one("opennck_s7_clients", "Connected clients.", clients);
    text.one("opennck_s7_connections_total", "Accepted connections.", counters.connections.get());
    text.family("opennck_s7_sent_away_total", "Rejected clients, by reason.");
    text.sample("opennck_s7_sent_away_total", &[("reason", "network")], counters.foreign.get());
    text.sample("opennck_s7_sent_away_total", &[("reason", "places")], counters.crowded.get());
    text.family("opennck_s7_ended_total", "Ended connections, by kind of end.");
    for (how, count) in counters.ends() {
        text.sample("opennck_s7_ended_total", &[("how", how)], count);
    }
    text.one("opennck_s7_answers_total", "Answers, connection confirms and pushes.", counters.answers.get());
    text.one("opennck_s7_pushes_total", "Updates sent for subscriptions.", counters.pushes.get());
    text.one("opennck_s7_writes_total", "Requests that changed the machine.", counters.writes.get());
    text.family(
        "opennck_s7_refusals_total",
        "Refused items (two-digit return codes) and requests (four-digit errors).",
    );
    for (refused, count) in counters.refusals() {
        let of = match refused {
            Refused::Item(_) => "item",
            Refused::Request(_) => "request",
        };
        let labels = [("of", of), ("code", &refused.to_string()), ("meaning", refused.meaning())];
        text.sample("opennck_s7_refusals_total", &labels, count);
    }
    text.one("opennck_s7_received_bytes_total", "Bytes received from clients.", counters.received.get());
    text.one("opennck_s7_sent_bytes_total", "Bytes sent to clients.", counters.sent.get());
    text.one("opennck_s7_faults_total", "Answers with an injected fault.", counters.faults.get());
    text.0
}

struct Text(String);

impl Text {
    /// A metric without labels.
    fn one(&mut self, name: &str, help: &str, value: impl Display) {
        self.family(name, help);
        self.sample(name, &[], value);
    }

    /// The description of a metric; its samples follow.
    fn family(&mut self, name: &str, help: &str) {
        let kind = if name.ends_with("_total") { "counter" } else { "gauge" };
        let _ = writeln!(self.0, "# HELP {name} {help}\n# TYPE {name} {kind}");
    }

    /// Labels are names and numbers of this program, so they contain no quotes, backslashes or line ends.
    fn sample(&mut self, name: &str, labels: &[(&str, &str)], value: impl Display) {
        self.0 += name;
        for (index, (label, said)) in labels.iter().enumerate() {
            let _ = write!(self.0, "{}{label}=\"{said}\"", if index == 0 { '{' } else { ',' });
        }
        let _ = writeln!(self.0, "{} {value}", if labels.is_empty() { "" } else { "}" });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(request: &str) -> Option<String> {
        let answer = answer_to(request.as_bytes(), || "opennck_steps_total 1\n".to_owned())?;
        Some(answer.lines().next().unwrap_or_default().to_owned())
    }

    #[test]
    fn one_path_is_there_and_requests_end() {
        assert_eq!(status("GET /metrics HTTP/1.1\r\nHost: a\r\n\r\n").unwrap(), "HTTP/1.1 200 OK");
        assert_eq!(status("GET /metrics?a=b HTTP/1.0\r\n\r\n").unwrap(), "HTTP/1.1 200 OK");
        assert_eq!(status("GET / HTTP/1.1\r\n\r\n").unwrap(), "HTTP/1.1 404 Not Found");
        assert_eq!(status("POST /metrics HTTP/1.1\r\n\r\n").unwrap(), "HTTP/1.1 405 Method Not Allowed");
        assert_eq!(status("\u{3}\0\0\u{16}").unwrap(), "HTTP/1.1 400 Bad Request");
        assert_eq!(status("GET /metr"), None);
        let endless = format!("GET /metrics HTTP/1.1\r\na: {}", "b".repeat(LONGEST));
        assert_eq!(status(&endless).unwrap(), "HTTP/1.1 431 Request Header Fields Too Large");
        let head = answer_to(b"HEAD /metrics HTTP/1.1\r\n\r\n", || "12345\n".to_owned()).unwrap();
        assert!(head.contains("Content-Length: 6\r\n") && head.ends_with("\r\n\r\n"));
    }
}
