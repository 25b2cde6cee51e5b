//! `specula bench`.
use super::Failure;
use super::common::Common;
/// Options of `bench`.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    common: Common,
}
/// Runs the command.
pub fn run(args: Args, _start: std::time::Instant) -> Result<(), Failure> {
    args.common.settings().map(|_| ())
}
