//! What a browser must prove. A page of another site can send requests to this computer, so each request must name this server
//! (`Host`) and, if a browser says where it comes from, come from this page (`Origin`, `Sec-Fetch-Site`). Beyond loopback a writer needs the
//! token that the server printed at its start.

use std::collections::hash_map::RandomState;
use std::hash::{BuildHasher, Hasher};
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{self, HeaderMap, HeaderName, HeaderValue};
use axum::http::{Method, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// The cookie with the token.
const COOKIE: &str = "opennck_token";
/// What the page may load: only files of this server, and nothing inline.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; \
                      frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// The names and the token of a server.
#[derive(Debug)]
pub(super) struct Guard {
    ports: Vec<u16>,
    /// Names that are no addresses.
    hosts: Vec<String>,
    /// The token of writers; `None` on loopback.
    token: Option<String>,
}

impl Guard {
    pub(super) fn new(addresses: &[SocketAddr], hosts: &[String]) -> Self {
        let is_open = addresses.iter().any(|address| !address.ip().to_canonical().is_loopback());
        let ports = addresses.iter().map(SocketAddr::port).collect();
        let names = hosts.iter().map(|name| name.to_ascii_lowercase());
        let hosts = std::iter::once("localhost".to_owned()).chain(names).collect();
        Self { ports, hosts, token: is_open.then(token) }
    }

    pub(super) fn token(&self) -> Option<&str> {
        self.token.as_deref()
    }

    /// Whether a name and a port in `Host` are this server's. Another site can have its own name point here, but it cannot have an address
    /// as its name.
    fn is_host(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if !port.ends_with(']') => (name, port.parse().ok()),
            Some(_) | None => (host, Some(80)),
        };
        let plain = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
        let is_known = plain.parse::<IpAddr>().is_ok() || self.hosts.contains(&name.to_ascii_lowercase());
        is_known && port.is_some_and(|port| self.ports.contains(&port))
    }

    /// The status with which a request is refused, and what to say.
    fn refusal(&self, request: &Request) -> Option<(StatusCode, &'static str)> {
        let text = |name: HeaderName| request.headers().get(name).map(|value| value.to_str().unwrap_or_default());
        let host = text(header::HOST).or_else(|| request.uri().authority().map(|authority| authority.as_str()));
        let Some(host) = host.filter(|host| self.is_host(host)) else {
            let cure = "this server does not have this name; use its address, or start it with --web-host NAME\n";
            return Some((StatusCode::MISDIRECTED_REQUEST, cure));
        };
        let is_write = !matches!(*request.method(), Method::GET | Method::HEAD);
        let is_foreign = text(header::ORIGIN).is_some_and(|origin| origin.strip_prefix("http://") != Some(host));
        let site = text(HeaderName::from_static("sec-fetch-site"));
        let is_other_site = site.is_some_and(|site| !matches!(site, "same-origin" | "none"));
        // A link of another site may lead to the page; nothing else of it is for other sites.
        if is_foreign || is_other_site && (is_write || request.uri().path() != "/") {
            return Some((StatusCode::FORBIDDEN, "the request comes from the page of another server\n"));
        }
        if is_write && text(header::CONTENT_TYPE).is_none_or(|kind| !kind.starts_with("application/json")) {
            return Some((StatusCode::FORBIDDEN, "expected Content-Type: application/json\n"));
        }
        None
    }

    /// Whether a client may write, as far as a token is needed.
    pub(super) fn may_write(&self, headers: &HeaderMap) -> bool {
        let Some(token) = &self.token else { return true };
        let text = |name| headers.get(name).and_then(|value: &HeaderValue| value.to_str().ok()).unwrap_or_default();
        let bearer = text(header::AUTHORIZATION).strip_prefix("Bearer ");
        let cookies = text(header::COOKIE).split(';').filter_map(|cookie| cookie.trim().split_once('='));
        let cookie = cookies.filter(|(name, _)| *name == COOKIE).map(|(_, value)| value).next();
        bearer.or(cookie).is_some_and(|given| is_same(token, given))
    }

    /// The cookie for a client that gave the right token.
    pub(super) fn cookie(&self, given: &str) -> Option<String> {
        let token = self.token.as_deref().filter(|token| is_same(token, given))?;
        Some(format!("{COOKIE}={token}; Path=/; HttpOnly; SameSite=Strict"))
    }
}

/// Compares in a time that depends only on the length.
fn is_same(token: &str, given: &str) -> bool {
    let differences = token.bytes().zip(given.bytes()).fold(0, |all, (one, other)| all | (one ^ other));
    token.len() == given.len() && std::hint::black_box(differences) == 0
}

/// 128 bits that nobody can guess: hashes with the random keys of the system.
fn token() -> String {
    let word = |_| format!("{:016x}", RandomState::new().build_hasher().finish());
    (0..2).map(word).collect()
}

/// Refuses what does not come from the page, and adds the headers of every answer.
pub(super) async fn guard(State(guard): State<Arc<Guard>>, request: Request, next: Next) -> Response {
    let mut answer = match guard.refusal(&request) {
        Some(refusal) => refusal.into_response(),
        None => next.run(request).await,
    };
    let headers = answer.headers_mut();
    headers.insert(header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(header::REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    answer
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guard_of(addresses: &[&str]) -> Guard {
        let addresses: Vec<_> = addresses.iter().map(|address| address.parse().unwrap()).collect();
        Guard::new(&addresses, &["Panel.example".to_owned()])
    }

    #[test]
    fn addresses_and_known_names_with_the_port_are_this_server() {
        let guard = guard_of(&["127.0.0.1:8080", "[::1]:8080"]);
        for host in ["127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "[::1]:8080", "panel.example:8080"] {
            assert!(guard.is_host(host), "{host}");
        }
        for host in ["", "evil.example:8080", "127.0.0.1:81", "127.0.0.1", "localhost", "[::1]", "localhost:8080:8080"]
        {
            assert!(!guard.is_host(host), "{host}");
        }
        assert!(guard_of(&["127.0.0.1:80"]).is_host("localhost"));
    }

    #[test]
    fn a_writer_needs_the_token_only_beyond_loopback() {
        assert!(guard_of(&["127.0.0.1:8080"]).may_write(&HeaderMap::new()));
        let guard = guard_of(&["127.0.0.1:8080", "0.0.0.0:8080"]);
        let token = guard.token().unwrap().to_owned();
        assert_eq!(token.len(), 32);
        assert_ne!(guard_of(&["0.0.0.0:8080"]).token(), Some(&*token));
        let with = |name, value: &str| HeaderMap::from_iter([(name, HeaderValue::from_str(value).unwrap())]);
        assert!(!guard.may_write(&HeaderMap::new()));
        assert!(guard.may_write(&with(header::AUTHORIZATION, &format!("Bearer {token}"))));
        assert!(!guard.may_write(&with(header::AUTHORIZATION, "Bearer ")));
        let cookie = guard.cookie(&token).unwrap();
        assert!(cookie.ends_with("; Path=/; HttpOnly; SameSite=Strict"));
        assert!(guard.may_write(&with(header::COOKIE, &format!("a=b; {COOKIE}={token}"))));
        assert!(!guard.may_write(&with(header::COOKIE, &format!("{COOKIE}={}", &token[1..]))));
        assert_eq!(guard.cookie("wrong"), None);
    }
}
