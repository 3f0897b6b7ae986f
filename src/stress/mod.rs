//! Stiff and extreme cases: what is promised of them, and whether it is kept.
//!
//! A [`Case`] is land made for it, its views, and promises. [`run()`] draws each view by every method and measures each
//! promise; [`report::stress`](crate::report::stress) writes it down. Promises and their limits stand in [`promise`] and
//! [`limits`], cases in [`cases`], what bends in [`exceptions`].
//!
//! | promise | measured by |
//! |---|---|
//! | drawn | whether any frame fails |
//! | finite | every f32 of the buffers of a frame with curves, creases and hachures, of its chains and its strokes: [`finite`] |
//! | watertight | pixels without a facet that five rays through the f64 mesh hit: [`watertight`] |
//! | unfolded | patches and facets of the limited surface that [fold](crate::surface::folds) |
//! | accurate, no-flood | ink against [truth](crate::truth): [`accuracy`] |
//! | conditioned | ink and truth of an eye a millionth of its distance on: [`conditioning`] |
//! | same-bits, turned | frames of the same land elsewhere: [`invariance`] |
//! | alone, steady | frames of a [`flight`] against the same drawn alone, and against the next |

pub(crate) mod accuracy;
pub(crate) mod case;
pub(crate) mod cases;
pub(crate) mod conditioning;
pub(crate) mod drawing;
pub(crate) mod exceptions;
pub(crate) mod figures;
pub(crate) mod finite;
pub(crate) mod flight;
pub(crate) mod folded;
pub(crate) mod illustrated;
pub(crate) mod invariance;
pub(crate) mod lands;
pub(crate) mod limits;
pub(crate) mod promise;
pub(crate) mod run;
pub(crate) mod sight;
pub(crate) mod watertight;

pub use case::{Case, Group};
pub use cases::{all, named, short};
pub(crate) use figures::Outcome;
pub use promise::{Check, Promise};
pub(crate) use run::run;
