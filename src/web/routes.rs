//! The paths of the server.

use std::sync::Arc;

use axum::Router;
use axum::body::{Body, Bytes};
use axum::extract::{DefaultBodyLimit, Path, Query, State};
use axum::http::header::{self, HeaderMap};
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::{Deserialize, Serialize};

use super::guard::{Guard, guard};
use super::hub::Hub;
use super::orders::{Protects, Refusal, execute};
use crate::machine::Command;
use crate::source::Problem;

/// The longest body of a request.
const LONGEST: usize = 64 * 1024;
const JSON: &str = "application/json";
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// The files of the page: name, type, content.
const FILES: [(&str, &str, &str); 13] = [
    ("style.css", "text/css; charset=utf-8", include_str!("page/style.css")),
    ("app.js", SCRIPT, include_str!("page/app.js")),
    ("dom.js", SCRIPT, include_str!("page/dom.js")),
    ("machine.js", SCRIPT, include_str!("page/machine.js")),
    ("status.js", SCRIPT, include_str!("page/status.js")),
    ("axes.js", SCRIPT, include_str!("page/axes.js")),
    ("alarms.js", SCRIPT, include_str!("page/alarms.js")),
    ("signals.js", SCRIPT, include_str!("page/signals.js")),
    ("panel.js", SCRIPT, include_str!("page/panel.js")),
    ("charts.js", SCRIPT, include_str!("page/charts.js")),
    ("why.js", SCRIPT, include_str!("page/why.js")),
    ("diagram.js", SCRIPT, include_str!("page/diagram.js")),
    ("scenario.js", SCRIPT, include_str!("page/scenario.js")),
];

/// What the paths need.
#[derive(Clone)]
pub(super) struct Site {
    pub(super) hub: Arc<Hub>,
    pub(super) guard: Arc<Guard>,
    pub(super) is_read_only: bool,
    pub(super) protects: Protects,
}

#[derive(Serialize)]
struct Error<'a> {
    error: &'a str,
    cure: &'a str,
}

#[derive(Deserialize)]
struct Why {
    signal: String,
    value: Option<u8>,
}

/// The number of the client whose key is pressed or released.
#[derive(Deserialize)]
struct Pressing {
    client: Option<u64>,
}

#[derive(Deserialize)]
struct Token {
    token: String,
}

pub(super) fn router(site: Site) -> Router {
    let layer = axum::middleware::from_fn_with_state(Arc::clone(&site.guard), guard);
    Router::new()
        .route("/", get(|| async { ([(header::CONTENT_TYPE, "text/html; charset=utf-8")], PAGE) }))
        .route("/favicon.svg", get(|| async { ([(header::CONTENT_TYPE, "image/svg+xml")], ICON) }))
        .route("/page/{name}", get(file))
        .route("/api/openapi.json", get(|| async { json(StatusCode::OK, OPENAPI) }))
        .route("/api/catalogue", get(catalogue))
        .route("/api/state", get(state))
        .route("/api/why", get(why))
        .route("/api/recording", get(recording))
        .route("/api/command", post(command))
        .route("/api/token", post(token))
        .route("/events", get(events))
        .layer(DefaultBodyLimit::max(LONGEST))
        .layer(layer)
        .with_state(site)
}

const PAGE: &str = include_str!("page/index.html");
const ICON: &str = include_str!("page/favicon.svg");
/// The description of these paths for programs. `tests/serve/openapi.rs` compares it with them.
const OPENAPI: &str = include_str!("../../docs/openapi.json");

fn json(status: StatusCode, text: impl Into<Body>) -> Response {
    (status, [(header::CONTENT_TYPE, JSON)], text.into()).into_response()
}

fn error(status: StatusCode, error: &str, cure: &str) -> Response {
    json(status, serde_json::to_string(&Error { error, cure }).unwrap_or_default())
}

fn wrong(problem: &Problem) -> Response {
    error(StatusCode::BAD_REQUEST, &problem.what, &problem.cure)
}

async fn file(Path(name): Path<String>) -> Response {
    match FILES.iter().find(|(known, ..)| *known == name) {
        Some((_, kind, content)) => ([(header::CONTENT_TYPE, *kind)], *content).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}

async fn catalogue(State(site): State<Site>) -> Response {
    json(StatusCode::OK, site.hub.catalogue().text.clone())
}

async fn state(State(site): State<Site>) -> Response {
    json(StatusCode::OK, site.hub.state())
}

async fn why(State(site): State<Site>, Query(asked): Query<Why>) -> Response {
    let wanted = asked.value.map(|value| value != 0);
    match site.hub.why_not(&asked.signal, wanted) {
        Ok(tree) => json(StatusCode::OK, tree),
        Err(problem) => wrong(&problem),
    }
}

async fn recording(State(site): State<Site>) -> Response {
    let Some(text) = site.hub.live().scenario() else {
        let cure = "a PLC program in another process cannot be repeated";
        return error(StatusCode::NOT_FOUND, "the session cannot be saved as a scenario", cure);
    };
    let disposition = HeaderValue::from_static("attachment; filename=\"session.toml\"");
    let kind = HeaderValue::from_static("application/toml; charset=utf-8");
    ([(header::CONTENT_TYPE, kind), (header::CONTENT_DISPOSITION, disposition)], text).into_response()
}

async fn command(
    State(site): State<Site>,
    Query(Pressing { client }): Query<Pressing>,
    headers: HeaderMap,
    body: Bytes,
) -> Response {
    if site.is_read_only {
        let cure = "start it without --read-only";
        return error(StatusCode::FORBIDDEN, "the machine can only be looked at", cure);
    }
    if !site.guard.may_write(&headers) {
        let cure = "open the address with #token=… that the server printed at its start";
        return error(StatusCode::FORBIDDEN, "a write from another computer needs the token", cure);
    }
    let holds = |commands: &[Command]| {
        if let Some(client) = client {
            site.hub.hold(client, commands);
        }
    };
    match execute(site.hub.live(), &body, &site.protects, holds).await {
        Ok(taken) => json(StatusCode::OK, serde_json::to_string(&taken).unwrap_or_default()),
        Err(Refusal::Wrong(problem)) => wrong(&problem),
        Err(Refusal::Forbidden(reason)) => error(StatusCode::FORBIDDEN, &reason, "write another address"),
    }
}

async fn token(State(site): State<Site>, body: Bytes) -> Response {
    let given = serde_json::from_slice::<Token>(&body).ok();
    match given.and_then(|given| site.guard.cookie(&given.token)) {
        Some(cookie) => (StatusCode::NO_CONTENT, [(header::SET_COOKIE, cookie)]).into_response(),
        None => error(StatusCode::FORBIDDEN, "the token is wrong", "use the one that the server printed at its start"),
    }
}

async fn events(State(site): State<Site>) -> Response {
    match site.hub.join() {
        Some(events) => ([(header::CONTENT_TYPE, "text/event-stream")], Body::from_stream(events)).into_response(),
        None => error(StatusCode::SERVICE_UNAVAILABLE, "too many pages are open", "close one"),
    }
}
