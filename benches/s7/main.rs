//! The cost of an S7 request: `opennck serve` compared with snap7's native server and a bare echo, in one run. `benches/README.md`
//! describes how to run it and its results.

#![expect(
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "it measures time, and prints rounded numbers"
)]

mod echo;
mod load;
mod servers;
mod soak;
mod timer;

use std::io;
use std::time::Duration;

use clap::Parser;

use load::Figures;
use servers::Server;
use timer::{Lateness, Timer};

/// The measurements.
#[derive(Debug, Parser)]
struct Arguments {
    /// Rounds of each row; medians are shown.
    #[arg(long, default_value_t = 4)]
    rounds: usize,
    /// Seconds per round.
    #[arg(long, default_value_t = 1.5)]
    seconds: f64,
    /// Numbers of connections; one table row each for every number in flight.
    #[arg(long, value_delimiter = ',', default_value = "1,8,32")]
    connections: Vec<usize>,
    /// Numbers of requests in flight on each connection.
    #[arg(long, value_delimiter = ',', default_value = "1,8")]
    in_flight: Vec<usize>,
    /// Number of idle connections, to measure the memory of one.
    #[arg(long, default_value_t = 1000)]
    held: usize,
    /// Runs only the soak: 32 clients of all kinds for this many seconds; checks that memory and handles do not grow.
    #[arg(long, value_name = "SECONDS")]
    soak: Option<u64>,
    /// Requests per second of the soak.
    #[arg(long, default_value_t = 2000.0)]
    rate: f64,
    /// Runs only the load, on a running server that has the block.
    #[arg(long, value_name = "ADDR:PORT")]
    only: Option<std::net::SocketAddr>,
    /// The server of `--only` is an echo.
    #[arg(long, requires = "only")]
    bare: bool,
    /// Runs as the echo.
    #[arg(long, hide = true)]
    echo: bool,
    /// Passed by cargo to every bench.
    #[arg(long, hide = true)]
    bench: bool,
}

/// One row: medians of the rounds.
struct Row {
    name: &'static str,
    figures: Figures,
    processor: f64,
}

fn main() -> io::Result<()> {
    let arguments = Arguments::parse();
    if arguments.echo {
        return echo::serve();
    }
    if let Some(address) = arguments.only {
        for &in_flight in &arguments.in_flight {
            for &connections in &arguments.connections {
                let time = Duration::from_secs_f64(arguments.seconds);
                let Figures { per_second, p50, p99, p999, .. } =
                    load::run(address, !arguments.bare, connections, in_flight, time)?;
                println!(
                    "{connections} × {in_flight}: {per_second:.0} req/s, p50 {p50:.0}, p99 {p99:.0}, p99.9 {p999:.0} µs"
                );
            }
        }
        return Ok(());
    }
    if let Some(seconds) = arguments.soak {
        let server = Server::opennck()?;
        let is_good = soak::run(&server, 32, Duration::from_secs(seconds), arguments.rate);
        show_log(server);
        return if is_good { Ok(()) } else { Err(io::Error::other("the soak failed")) };
    }
    let mut servers = vec![Server::opennck()?, Server::echo()?];
    match Server::snap7() {
        Ok(server) => servers.insert(1, server),
        Err(error) => println!("snap7 was NOT measured, so its ratios are missing: {error}\n"),
    }
    let timer = Timer::start();
    let mut misses = 0;
    println!("| server | connections | in flight | req/s | p50 µs | p99 µs | p99.9 µs | processor µs |");
    println!("|---|---|---|---|---|---|---|---|");
    let mut ratios = String::new();
    for &in_flight in &arguments.in_flight {
        for &connections in &arguments.connections {
            let rows = rows(&servers, connections, in_flight, &arguments)?;
            for Row { name, figures, processor } in &rows {
                let Figures { per_second, p50, p99, p999, .. } = figures;
                println!(
                    "| {name} | {connections} | {in_flight} | {per_second:.0} | {p50:.0} | {p99:.0} | {p999:.0} | {processor:.2} |"
                );
            }
            let own = &rows[0];
            let mut ratio = |what: &str, value: f64, is_met: bool, aim: &str| {
                misses += usize::from(!is_met);
                let verdict = if is_met { "" } else { " MISSED" };
                ratios += &format!("| {connections} × {in_flight} | {what} | {value:.2} | {aim}{verdict} |\n");
            };
            if let Some(snap7) = rows.iter().find(|row| row.name == "snap7") {
                let speed = own.figures.per_second / snap7.figures.per_second;
                let least = if connections >= 32 { 2.0 } else { 1.0 };
                ratio("req/s of snap7's", speed, speed > least, &format!("> {least}"));
                let part = own.processor / snap7.processor;
                ratio("processor of snap7's", part, part <= 0.5, "≤ 0.5");
            }
            ratio("processor µs", own.processor, own.processor <= 8.0, "≤ 8");
            if let Some(echo) = rows.iter().find(|row| row.name == "echo") {
                let tail = own.figures.p99 / echo.figures.p99;
                ratio("p99 of the echo's", tail, tail <= 1.3, "≤ 1.3");
            }
        }
    }
    println!("\n| row | ratio | value | aim |\n|---|---|---|---|\n{ratios}");
    held(&servers[0], arguments.held)?;
    servers.into_iter().for_each(show_log);
    let Lateness { cycles, late, worst } = timer.end();
    println!("a bare timer of 2 ms meanwhile: {late} of {cycles} cycles late by more than one, the worst {worst:.1?}");
    println!("{misses} aims were missed");
    Ok(())
}

/// Ends a server and shows its output, without the lines about connections.
fn show_log(server: Server) {
    let name = server.name;
    let said = server.end();
    for line in said
        .lines()
        .filter(|line| ![" connected", " disconnected", "were omitted"].iter().any(|usual| line.contains(usual)))
    {
        println!("{name}: {line}");
    }
}

/// Measures the servers alternately, round by round.
fn rows(servers: &[Server], connections: usize, in_flight: usize, arguments: &Arguments) -> io::Result<Vec<Row>> {
    let mut rounds: Vec<Vec<(Figures, f64)>> = servers.iter().map(|_| Vec::new()).collect();
    for _ in 0..arguments.rounds {
        for (server, rounds) in servers.iter().zip(&mut rounds) {
            let time = Duration::from_secs_f64(arguments.seconds);
            let before = server.processor();
            let figures = load::run(server.address, server.knows_s7, connections, in_flight, time)
                .map_err(|error| io::Error::other(format!("{}: {error}", server.name)))?;
            let processor = (server.processor() - before).as_secs_f64() * 1e6 / figures.answers as f64;
            rounds.push((figures, processor));
        }
    }
    Ok(servers.iter().zip(rounds).map(|(server, rounds)| middle(server.name, &rounds)).collect())
}

fn middle(name: &'static str, rounds: &[(Figures, f64)]) -> Row {
    let of = |value: fn(&(Figures, f64)) -> f64| {
        let mut values: Vec<_> = rounds.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        let half = values.len() / 2;
        if values.len() % 2 == 0 { f64::midpoint(values[half - 1], values[half]) } else { values[half] }
    };
    let figures = Figures {
        per_second: of(|round| round.0.per_second),
        p50: of(|round| round.0.p50),
        p99: of(|round| round.0.p99),
        p999: of(|round| round.0.p999),
        answers: rounds.iter().map(|round| round.0.answers).sum(),
    };
    Row { name, figures, processor: of(|round| round.1) }
}

/// Measures the memory of a connection that is idle after its first requests.
fn held(server: &Server, count: usize) -> io::Result<()> {
    use io::{Read, Write};
    let before = server.memory();
    let mut clients = Vec::new();
    for _ in 0..count {
        clients.push(load::connect(server.address, server.knows_s7)?);
    }
    for client in &mut clients {
        client.write_all(&load::request())?;
        client.read_exact(&mut [0; load::ANSWER])?;
    }
    let each = (server.memory().saturating_sub(before)) as f64 / count.max(1) as f64 / 1024.0;
    let figures = load::run(server.address, server.knows_s7, 32, 8, Duration::from_secs(2))?;
    println!(
        "{count} connections held: {each:.2} KiB of memory each (aim: below 8), {} handles; beside them 32 × 8: {:.0} req/s, p99 {:.0} µs\n",
        server.handles(),
        figures.per_second,
        figures.p99
    );
    Ok(())
}
