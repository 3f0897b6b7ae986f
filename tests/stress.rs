//! Stiff and extreme cases: the registry is sound, each promise is found broken where it is, and the short list keeps all of them.

mod broken;
mod islands;
mod registry;
mod rims;
mod runs;
