//! Who may connect: everybody, or users with passwords. Without encryption, that is for clients on this computer; with encryption, the server
//! also asks for a certificate that it trusts.

use std::sync::Arc;

use async_trait::async_trait;
use opcua::server::ServerEndpoint;
use opcua::server::authenticator::{
    AuthManager, Password, UserToken, user_pass_security_policy_id, user_pass_security_policy_uri,
};
use opcua::types::{Error, StatusCode, UAString, UserTokenPolicy, UserTokenType};

use super::manager::Manager;
use super::options::{OpcUaOptions, User};

/// The name that the library expects of the policy without a user.
const ANONYMOUS: &str = "anonymous";

/// Admits clients.
pub(super) struct Door {
    manager: Arc<Manager>,
    options: Arc<OpcUaOptions>,
}

impl Door {
    pub(super) fn new(manager: Arc<Manager>, options: Arc<OpcUaOptions>) -> Self {
        Self { manager, options }
    }
}

/// Compares in a time that depends only on the length.
fn is_same(password: &str, given: &str) -> bool {
    let differences = password.bytes().zip(given.bytes()).fold(0, |all, (one, other)| all | (one ^ other));
    password.len() == given.len() && std::hint::black_box(differences) == 0
}

fn policy(policy_id: UAString, token_type: UserTokenType, security: UAString) -> UserTokenPolicy {
    UserTokenPolicy {
        policy_id,
        token_type,
        issued_token_type: UAString::null(),
        issuer_endpoint_url: UAString::null(),
        security_policy_uri: security,
    }
}

#[async_trait]
impl AuthManager for Door {
    async fn authenticate_anonymous_token(&self, _: &ServerEndpoint) -> Result<(), Error> {
        if !self.options.users.is_empty() {
            return Err(Error::new(StatusCode::BadIdentityTokenRejected, "a user is needed"));
        }
        self.manager.begin();
        Ok(())
    }

    async fn authenticate_username_identity_token(
        &self,
        _: &ServerEndpoint,
        name: &str,
        password: &Password,
    ) -> Result<UserToken, Error> {
        let is_it = |user: &&User| user.name == name && is_same(&user.password, password.get());
        let Some(user) = self.options.users.iter().find(is_it) else {
            tracing::info!("OPC UA: rejected user {name:?}: no such user, or another password");
            return Err(Error::new(StatusCode::BadUserAccessDenied, "no such user, or another password"));
        };
        self.manager.begin();
        Ok(UserToken(user.name.clone()))
    }

    fn user_token_policies(&self, endpoint: &ServerEndpoint) -> Vec<UserTokenPolicy> {
        if self.options.users.is_empty() {
            return vec![policy(ANONYMOUS.into(), UserTokenType::Anonymous, UAString::null())];
        }
        // A password is encrypted as the endpoint is.
        let security = user_pass_security_policy_uri(endpoint);
        vec![policy(user_pass_security_policy_id(endpoint), UserTokenType::UserName, security)]
    }
}
