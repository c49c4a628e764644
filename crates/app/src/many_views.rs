//! How many views come about, as the user asks for it.

use crate::failure::Failure;
use clap::{Args, ValueEnum};

/// Flags of many views.
#[derive(Debug, Clone, Args)]
pub(crate) struct ViewsArgs {
    /// How the views are made: each by a cast, or derived from a few that are.
    #[arg(long, value_enum, value_name = "METHOD", default_value_t = ViewsMethod::Auto)]
    views_method: ViewsMethod,

    /// How many views are cast for the others to be derived from [default: as many as it takes].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024), allow_negative_numbers = true)]
    anchors: Option<u32>,
}

/// How many views are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ViewsMethod {
    /// From anchors if a number of them is given, else each by a cast.
    Auto,
    /// Each by a cast.
    Each,
    /// From a few anchors; only composites (dvr), on a GPU. Faster, and less exact.
    Anchors,
}

/// Views from anchors, as they are asked for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AnchorRequest {
    /// How many anchors; as many as it takes if not given.
    pub(crate) count: Option<u32>,
}

impl ViewsArgs {
    /// The anchors that are asked for; nothing where each view is to be cast.
    pub(crate) fn resolve(&self) -> Result<Option<AnchorRequest>, Failure> {
        match (self.views_method, self.anchors) {
            (ViewsMethod::Each, Some(_)) => {
                Err(Failure::input("--anchors needs --views-method anchors: each has none"))
            }
            (ViewsMethod::Each | ViewsMethod::Auto, None) => Ok(None),
            (ViewsMethod::Auto | ViewsMethod::Anchors, count) => Ok(Some(AnchorRequest { count })),
        }
    }
}
