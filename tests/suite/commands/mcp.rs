//! `specula mcp`: a server for agents, with the official client.

use super::python::run_script;

#[test]
fn an_agent_sees_edits_and_measures() {
    run_script("agent.py", tempfile::tempdir().unwrap().path());
}
