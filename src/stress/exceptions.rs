//! What bends: promises with a limit of their own, which counts from then on. Each says why, and what was tried.
//!
//! Of accuracy there are seven, where three were aimed at: the walk inks too much or too little where undersides of the land are seen or
//! away sides are slivers, while the contour is right in all but two of these views. Figures are those of 2026-11-29.

use super::promise::Promise;

/// A promise that a case keeps by another limit than all others.
#[derive(Debug, Clone, Copy)]
pub struct Exception {
    /// Name of the case.
    pub case: &'static str,
    /// Name of its view.
    pub view: &'static str,
    /// Name of the method.
    pub method: &'static str,
    /// What is promised.
    pub promise: Promise,
    /// The limit that counts from then on.
    pub limit: f64,
    /// Why, and what was tried.
    pub reason: &'static str,
}

const NEEDLE: &str = "Along the flank of a needle the walk inks a second line 2 to 3 px inside the silhouette; the contour and \
                      toward-away do not. Tried: truth of level 64 in the place of 32, .965 and .963. The cause is not found.";
const TANGENT: &str = "Where the line of sight nearly touches a round ridge for 8 km the walk goes on inking for some pixels before \
                       the line ends; the contour does not. The cause is not found, nothing was tried.";
const UNDERSIDE: &str = "A pixel that shows the underside of the land counts as sky for its neighbours, and the walk inks some of them \
                         where truth has no line; the contour does not. Likely its ray, followed beyond the underside, meets facets \
                         that face away. Nothing was tried.";
const ON_A_SAMPLE: &str = "The eye lies on a sample: facets about it hold the eye, and what holds the eye counts as facing away. Truth and \
                           contour have a line there, the walk and toward-away parts of it; a millionth of the distance changes which. \
                           On an edge and in a facet they have all of it. Nothing was tried.";
const SLIVERS: &str = "Rows there twice make treads whose far sides are slivers on the page, each a line of truth; facets may deviate by \
                       0.15 px there, and chains under 2 px are left out. Nothing was tried.";
const FOLDS: &str = "Patches over white noise 10 cells high fold over, and lines stand a pixel apart; chains under 2 px are left out. Limited \
                     tangents leave no folds: see folds-limited.";
const ROUNDED: &str = "Offsets of vertices run from the north-west sample of a cell, which is another one on land that is turned: f32 \
                       rounds otherwise, and pixels at which it matters change sides. That this is the cause was not proven; \
                       nothing was tried.";
const NEARLY_EQUAL: &str = "On a cliff 320 km high within 2 km depths of toward and away surface in a pixel are nearly equal, and toward-away inks \
                            by which is nearer: some ends of lines come and go. Walk and contour do not. Nothing was tried.";
const TIES: &str = "On land that is mirrored, border lines of voids that meet in corners take the pixel beside; turned by 180 degrees they do \
                    not. The cause is not found, nothing was tried.";

const fn except(
    (case, view, method): (&'static str, &'static str, &'static str),
    promise: Promise,
    limit: f64,
    reason: &'static str,
) -> Exception {
    Exception { case, view, method, promise, limit, reason }
}

/// All of them.
pub const EXCEPTIONS: &[Exception] = &[
    except(("needle", "foot", "walk"), Promise::Accurate, 0.96, NEEDLE),
    except(("tangent", "flank", "walk"), Promise::Accurate, 0.97, TANGENT),
    except(("void-half", "across", "walk"), Promise::Accurate, 0.97, UNDERSIDE),
    except(("on-the-land", "sample", "walk"), Promise::Accurate, 0.59, ON_A_SAMPLE),
    except(("doubled-rows", "across", "walk"), Promise::Accurate, 0.85, SLIVERS),
    except(("doubled-rows", "across", "contour"), Promise::Accurate, 0.81, SLIVERS),
    except(("folds", "above", "contour"), Promise::Accurate, 0.96, FOLDS),
    except(("outside", "below-the-rim", "walk"), Promise::NoFlood, 0.002, UNDERSIDE),
    except(("folds", "above", "walk"), Promise::NoFlood, 0.0032, FOLDS),
    except(("folds", "above", "contour"), Promise::NoFlood, 0.0015, FOLDS),
    except(("on-the-land", "sample", "walk"), Promise::Conditioned, 160.0, ON_A_SAMPLE),
    except(("on-the-land", "sample", "toward-away"), Promise::Conditioned, 114.0, ON_A_SAMPLE),
    except(("cliff-10000", "below", "toward-away"), Promise::Conditioned, 10.0, NEARLY_EQUAL),
    except(("mountains", "valley", "walk"), Promise::Turned, 4.0, ROUNDED),
    except(("cliff-10", "below", "walk"), Promise::Turned, 7.0, ROUNDED),
    except(("cliff-10", "below", "walk"), Promise::TurnedFar, 3.0, ROUNDED),
    except(("cliff-10000", "below", "walk"), Promise::Turned, 64.0, ROUNDED),
    except(("terraces", "above", "walk"), Promise::Turned, 4.0, ROUNDED),
    except(("saw-tooth", "along", "walk"), Promise::Turned, 6.0, ROUNDED),
    except(("saw-tooth", "along", "walk"), Promise::TurnedFar, 1.0, ROUNDED),
    except(("folds", "above", "walk"), Promise::TurnedFar, 1.0, ROUNDED),
    except(("dunes", "grazing", "walk"), Promise::Turned, 7.0, ROUNDED),
    except(("pixel-centres", "row", "walk"), Promise::Turned, 12.0, ROUNDED),
    except(("tangent", "crest", "walk"), Promise::Turned, 13.0, ROUNDED),
    except(("tangent", "flank", "walk"), Promise::Turned, 5.0, ROUNDED),
    except(("doubled-rows", "across", "walk"), Promise::Turned, 2.0, ROUNDED),
    except(("void-checkerboard", "across", "walk"), Promise::Turned, 32.0, TIES),
    except(("void-checkerboard", "above", "walk"), Promise::Turned, 87.0, TIES),
];

/// The exception of a promise.
pub fn exception(case: &str, view: &str, method: &str, promise: Promise) -> Option<&'static Exception> {
    let is_it = |e: &&Exception| (e.case, e.view, e.method, e.promise) == (case, view, method, promise);
    EXCEPTIONS.iter().find(is_it)
}
