//! Rooms that are no part of the public face, for the tests, benchmarks and commands of this
//! repository alone: names and behaviour change without notice.

/// Shows rooms under the last of their names.
macro_rules! shown {
    ($($(#[$when:meta])* $($room:ident)::+ => $name:ident;)+) => {
        $(
            $(#[$when])*
            #[doc = concat!("Inner parts of `", stringify!($name), "`.")]
            pub mod $name {
                pub use crate::$($room)::+::*;
            }
        )+
    };
}

shown! {
    clock => clock;
    space => space;
    physics => physics;
    #[cfg(feature = "solver")] encoding => encoding;
    #[cfg(feature = "solver")] scene => scene;
    #[cfg(feature = "solver")] analysis::direction => direction;
    #[cfg(feature = "geometry")] analysis::interference => interference;
    #[cfg(feature = "solver")] analysis::motion => motion;
    #[cfg(feature = "solver")] analysis::stack => stack;
    #[cfg(feature = "solver")] analysis::start => start;
    #[cfg(feature = "solver")] analysis::system => system;
    #[cfg(feature = "solver")] analysis::time => time;
    #[cfg(feature = "solver")] analysis::warning => warning;
    #[cfg(feature = "solver")] analysis::work_precision => work_precision;
    #[cfg(feature = "pages")] report => report;
}

/// Inner parts of `dataset`.
#[cfg(feature = "solver")]
pub mod dataset {
    shown! {
        dataset::manual => manual;
        dataset::row => row;
        dataset::statement => statement;
        dataset::surface => surface;
        dataset::syntax => syntax;
        dataset::value => value;
    }
}

/// Inner parts of `numeric`.
#[cfg(feature = "solver")]
pub mod numeric {
    shown! {
        numeric::event => event;
        numeric::rank => rank;
    }
}

/// Inner parts of `results`.
#[cfg(feature = "solver")]
pub mod results {
    shown! {
        results::kept => kept;
        results::output_folder => output_folder;
    }
}

/// Inner parts of `verify`.
#[cfg(feature = "solver")]
pub mod verify {
    shown! {
        analysis::verify::idle => idle;
        analysis::verify::outline => outline;
    }
}
