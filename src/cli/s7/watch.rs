//! `opennck s7 watch`: a line for each change, with the time in seconds since the start. Lost connections are told on standard
//! error, and watching goes on when they are there again.

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

/// How to watch.
#[derive(Clone, Copy, Debug)]
pub(super) struct How {
    pub(super) every: Duration,
    pub(super) cyclic: bool,
    pub(super) format: Format,
}

/// What comes from the sources.
enum News {
    /// A value of a target.
    Value(usize, Result<Value, Error>),
    /// Something about a connection.
    Connection(String),
    /// Nothing more will come.
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
    let (to, mut news) = mpsc::channel(256);
    for source in sources {
        tokio::spawn(tell_of_connection(source.name, source.client.changes(), to.clone()));
        tokio::spawn(follow(source, how, to.clone()));
    }
    drop(to);
    let mut screen = Screen::new(&targets, how.format);
    screen.head(output);
    let mut end =
        std::pin::pin!(crate::cli::interrupt::signals().map_err(|error| {
            Problem::new(format!("the system gives no signals: {error}"), "close other programs")
        })?);
    let mut gone = std::pin::pin!(reader_gone());
    loop {
        let came = tokio::select! {
            () = &mut end => return Ok(0),
            () = &mut gone => return Ok(0),
            came = news.recv() => came,
        };
        match came {
            Some(News::Value(at, value)) => screen.take(at, &value, output),
            Some(News::Connection(text)) => output.warning(text),
            Some(News::End(failure)) => return Err(failure),
            None => return Ok(0),
        }
        if output.is_closed() {
            return Ok(0); // nobody reads any more
        }
    }
}

/// Waits until nobody reads standard output any more, as behind `head`; whatever comes, and if nothing comes, too.
#[cfg(unix)]
async fn reader_gone() {
    use std::os::fd::AsFd;
    use tokio::io::Interest;
    use tokio::net::unix::pipe::Sender;
    // Nothing is written through it: it stays as it is, and only tells of an error. Where it is a file there is nobody to go.
    let watched = std::io::stdout().as_fd().try_clone_to_owned().and_then(Sender::from_owned_fd_unchecked);
    match watched {
        Ok(watched) if watched.ready(Interest::ERROR).await.is_ok() => {}
        Ok(_) | Err(_) => std::future::pending().await,
    }
}

#[cfg(not(unix))]
async fn reader_gone() {
    std::future::pending().await
}

/// Values of one source, read again and again or sent by the module.
async fn follow(source: Source, how: How, to: mpsc::Sender<News>) {
    if how.cyclic {
        let subscribed = source.client.subscribe(&source.variables, Mode::Cycle, how.every).await;
        let mut subscription = match subscribed {
            Ok(subscription) => subscription,
            Err(error) => return drop(to.send(News::End(error.into())).await),
        };
        while let Some(update) = subscription.next().await {
            match update {
                Ok(update) => {
                    for (at, value) in update.values {
                        let _ = to.send(News::Value(source.targets[at], value)).await;
                    }
                }
                Err(error) => return drop(to.send(News::End(error.into())).await),
            }
        }
        return;
    }
    let mut ticks = interval(how.every);
    ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        ticks.tick().await;
        for (at, value) in source.targets.iter().zip(source.client.read_all(&source.variables).await) {
            // A lost connection is told by itself.
            if value.as_ref().err().is_some_and(Error::is_of_the_connection) {
                continue;
            }
            if to.send(News::Value(*at, value)).await.is_err() {
                return;
            }
        }
    }
}

async fn tell_of_connection(
    name: &'static str,
    mut state: tokio::sync::watch::Receiver<State>,
    to: mpsc::Sender<News>,
) {
    let mut is_lost = false;
    while state.changed().await.is_ok() {
        let text = match &*state.borrow_and_update() {
            State::Lost { .. } if is_lost => continue,
            State::Connected(_) if !is_lost => continue, // the first one
            State::Lost { cause, .. } => {
                is_lost = true;
                format!("{name}: the connection was lost ({cause}); trying again")
            }
            State::Connected(_) => {
                is_lost = false;
                format!("{name}: connected again")
            }
            State::Ended { cause } => format!("{name}: the connection was lost ({cause})"),
        };
        if to.send(News::Connection(text)).await.is_err() {
            return;
        }
    }
}

/// What was printed.
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

    /// Prints a value if it is another one than before.
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

/// Address, and symbol where there is one.
fn name(target: &Target) -> String {
    if target.symbol.is_empty() { target.address() } else { format!("{}  {}", target.address(), target.symbol) }
}
