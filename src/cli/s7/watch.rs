//! `opennck s7 watch`: prints a line for each change, with the time in seconds since the start. A lost connection is reported on standard
//! error; watching resumes after the reconnect.

use std::time::Duration;

use tokio::sync::mpsc;
use tokio::time::{Instant, MissedTickBehavior, interval};

use super::arguments::{Host, Names};
use super::cells::{Cell, cells};
use super::failure::Failure;
use super::sources::{self, Source};
use super::targets::{Dictionary, Target};
use crate::cli::list::Format;
use crate::cli::output::Output;
use crate::s7::client::{Error, Mode, State, Value};
use crate::source::Problem;

/// The options of the command.
#[derive(Clone, Copy, Debug)]
pub(super) struct How {
    pub(super) every: Duration,
    pub(super) cyclic: bool,
    pub(super) format: Format,
}

/// An event from a source.
enum Event {
    /// A value of a target.
    Value(usize, Result<Value, Error>),
    /// A message about a connection.
    Connection(String),
    /// The source has ended.
    End(Failure),
}

pub(super) async fn watch(
    host: &Host,
    addresses: &[String],
    names: &Names,
    how: How,
    output: &mut Output,
) -> Result<u8, Failure> {
    let targets = Dictionary::open(names)?.targets(host, addresses).await?;
    let sources = sources::open(host, &targets).await?;
    let (to, mut events) = mpsc::channel(256);
    for source in sources {
        tokio::spawn(report_connection(source.name, source.client.changes(), to.clone()));
        tokio::spawn(follow(source, how, to.clone()));
    }
    drop(to);
    let mut screen = Screen::new(&targets, how.format);
    screen.head(output);
    let mut end = std::pin::pin!(crate::cli::interrupt::signals().map_err(|error| {
        Problem::new(format!("cannot wait for Ctrl-C and SIGTERM: {error}"), "close other programs")
    })?);
    let mut closed = std::pin::pin!(reader_closed());
    loop {
        let event = tokio::select! {
            () = &mut end => return Ok(0),
            () = &mut closed => return Ok(0),
            event = events.recv() => event,
        };
        match event {
            Some(Event::Value(at, value)) => screen.take(at, &value, output),
            Some(Event::Connection(text)) => output.warning(text),
            Some(Event::End(failure)) => return Err(failure),
            None => return Ok(0),
        }
        if output.is_closed() {
            return Ok(0); // the reader has closed standard output
        }
    }
}

/// Waits until the reader closes standard output, as `head` does. This also works when no values arrive.
#[cfg(unix)]
async fn reader_closed() {
    use std::os::fd::AsFd;
    use tokio::io::Interest;
    use tokio::net::unix::pipe::Sender;
    // Nothing is written through this handle; it only reports the error state of the pipe. A file has no reader that could close it.
    let watched = std::io::stdout().as_fd().try_clone_to_owned().and_then(Sender::from_owned_fd_unchecked);
    match watched {
        Ok(watched) if watched.ready(Interest::ERROR).await.is_ok() => {}
        Ok(_) | Err(_) => std::future::pending().await,
    }
}

#[cfg(not(unix))]
async fn reader_closed() {
    std::future::pending().await
}

/// Values of one source, polled or sent by the module.
async fn follow(source: Source, how: How, to: mpsc::Sender<Event>) {
    if how.cyclic {
        let subscribed = source.client.subscribe(&source.variables, Mode::Cycle, how.every).await;
        let mut subscription = match subscribed {
            Ok(subscription) => subscription,
            Err(error) => return drop(to.send(Event::End(error.into())).await),
        };
        while let Some(update) = subscription.next().await {
            match update {
                Ok(update) => {
                    for (at, value) in update.values {
                        let _ = to.send(Event::Value(source.targets[at], value)).await;
                    }
                }
                Err(error) => return drop(to.send(Event::End(error.into())).await),
            }
        }
        return;
    }
    let mut ticks = interval(how.every);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        ticks.tick().await;
        for (at, value) in source.targets.iter().zip(source.client.read_all(&source.variables).await) {
            // A lost connection is reported separately.
            if value.as_ref().err().is_some_and(Error::is_of_the_connection) {
                continue;
            }
            if to.send(Event::Value(*at, value)).await.is_err() {
                return;
            }
        }
    }
}

async fn report_connection(
    name: &'static str,
    mut state: tokio::sync::watch::Receiver<State>,
    to: mpsc::Sender<Event>,
) {
    let mut is_lost = false;
    while state.changed().await.is_ok() {
        let text = match &*state.borrow_and_update() {
            State::Lost { .. } if is_lost => continue,
            State::Connected(_) if !is_lost => continue, // the first one
            State::Lost { cause, .. } => {
                is_lost = true;
                format!("{name}: connection lost ({cause}); reconnecting")
            }
            State::Connected(_) => {
                is_lost = false;
                format!("{name}: reconnected")
            }
            State::Ended { cause } => format!("{name}: connection lost ({cause})"),
        };
        if to.send(Event::Connection(text)).await.is_err() {
            return;
        }
    }
}

/// What has been printed.
struct Screen<'a> {
    targets: &'a [Target],
    format: Format,
    begin: Instant,
    last: Vec<Option<[Cell; 2]>>,
    width: usize,
}

impl<'a> Screen<'a> {
    fn new(targets: &'a [Target], format: Format) -> Self {
        let width = targets.iter().map(|target| name(target).chars().count()).max().unwrap_or(0);
        Self { targets, format, begin: Instant::now(), last: vec![None; targets.len()], width }
    }

    fn head(&self, output: &mut Output) {
        if self.format == Format::Csv {
            output.line("time,address,symbol,value,hex");
        }
    }

    /// Prints a value if it has changed.
    fn take(&mut self, at: usize, value: &Result<Value, Error>, output: &mut Output) {
        let target = &self.targets[at];
        let cells = cells(target, value);
        if self.last[at].as_ref() == Some(&cells) {
            return;
        }
        let [Cell { text: value, json }, Cell { text: hex, .. }] = &cells;
        let time = self.begin.elapsed().as_secs_f64();
        match self.format {
            Format::Table => {
                let (name, width) = (name(target), self.width);
                let line = match &self.last[at] {
                    None => format!("{time:>10.3}  {name:<width$}  {value}"),
                    Some([before, _]) => format!("{time:>10.3}  {name:<width$}  {} -> {value}", before.text),
                };
                output.line(line.trim_end());
            }
            Format::Json => output.line(serde_json::json!({
                "t": (time * 1000.0).round() / 1000.0,
                "address": target.address(),
                "symbol": target.symbol,
                "value": json,
                "hex": hex,
            })),
            Format::Csv => {
                let time = format!("{time:.3}");
                let mut writer = csv::Writer::from_writer(Vec::new());
                let address = target.address();
                let written = writer.write_record([&time, &address, &target.symbol, value, hex]);
                if let (Ok(()), Ok(bytes)) = (written, writer.into_inner()) {
                    output.print(&String::from_utf8_lossy(&bytes));
                }
            }
        }
        self.last[at] = Some(cells);
    }
}

/// The address, and the symbol if there is one.
fn name(target: &Target) -> String {
    if target.symbol.is_empty() { target.address() } else { format!("{}  {}", target.address(), target.symbol) }
}
