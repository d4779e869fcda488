//! Rooms that are no part of the public face, for the tests, benchmarks and commands of this
//! repository alone: names and behaviour change without notice.

/// Inner parts of `clock`.
pub mod clock {
    pub use crate::clock::*;
}
/// Inner parts of `encoding`.
#[cfg(feature = "solver")]
pub mod encoding {
    pub use crate::encoding::*;
}
/// Inner parts of `space`.
pub mod space {
    pub use crate::space::*;
}
/// Inner parts of `physics`.
pub mod physics {
    pub use crate::physics::*;
}
/// Inner parts of `scene`.
#[cfg(feature = "solver")]
pub mod scene {
    pub use crate::scene::*;
}
/// Inner parts of `accuracy`.
#[cfg(feature = "solver")]
pub mod accuracy {
    pub use crate::analysis::accuracy::*;
}
/// Inner parts of `direction`.
#[cfg(feature = "solver")]
pub mod direction {
    pub use crate::analysis::direction::*;
}
/// Inner parts of `interference`.
#[cfg(feature = "geometry")]
pub mod interference {
    pub use crate::analysis::interference::*;
}
/// Inner parts of `motion`.
#[cfg(feature = "solver")]
pub mod motion {
    pub use crate::analysis::motion::*;
}
/// Inner parts of `stack`.
#[cfg(feature = "solver")]
pub mod stack {
    pub use crate::analysis::stack::*;
}
/// Inner parts of `start`.
#[cfg(feature = "solver")]
pub mod start {
    pub use crate::analysis::start::*;
}
/// Inner parts of `statics`.
#[cfg(feature = "solver")]
pub mod statics {
    pub use crate::analysis::statics::*;
}
/// Inner parts of `system`.
#[cfg(feature = "solver")]
pub mod system {
    pub use crate::analysis::system::*;
}
/// Inner parts of `time`.
#[cfg(feature = "solver")]
pub mod time {
    pub use crate::analysis::time::*;
}
/// Inner parts of `trajectory`.
#[cfg(feature = "solver")]
pub mod trajectory {
    pub use crate::analysis::trajectory::*;
}
/// Inner parts of `warning`.
#[cfg(feature = "solver")]
pub mod warning {
    pub use crate::analysis::warning::*;
}
/// Inner parts of `work_precision`.
#[cfg(feature = "solver")]
pub mod work_precision {
    pub use crate::analysis::work_precision::*;
}
/// Inner parts of `dataset`.
#[cfg(feature = "solver")]
pub mod dataset {
    /// Inner parts of `lens`.
    pub mod lens {
        pub use crate::dataset::lens::*;
    }
    /// Inner parts of `manual`.
    pub mod manual {
        pub use crate::dataset::manual::*;
    }
    /// Inner parts of `mesh`.
    pub mod mesh {
        pub use crate::dataset::mesh::*;
    }
    /// Inner parts of `read`.
    pub mod read {
        pub use crate::dataset::read::*;
    }
    /// Inner parts of `row`.
    pub mod row {
        pub use crate::dataset::row::*;
    }
    /// Inner parts of `statement`.
    pub mod statement {
        pub use crate::dataset::statement::*;
    }
    /// Inner parts of `surface`.
    pub mod surface {
        pub use crate::dataset::surface::*;
    }
    /// Inner parts of `syntax`.
    pub mod syntax {
        pub use crate::dataset::syntax::*;
    }
    /// Inner parts of `value`.
    pub mod value {
        pub use crate::dataset::value::*;
    }
}
/// Inner parts of `report`.
#[cfg(feature = "pages")]
pub mod report {
    pub use crate::report::*;
}
/// Inner parts of `numeric`.
#[cfg(feature = "solver")]
pub mod numeric {
    /// Inner parts of `bernstein`.
    pub mod bernstein {
        pub use crate::numeric::bernstein::*;
    }
    /// Inner parts of `connected`.
    pub mod connected {
        pub use crate::numeric::connected::*;
    }
    /// Inner parts of `control`.
    pub mod control {
        pub use crate::numeric::control::*;
    }
    /// Inner parts of `dense`.
    pub mod dense {
        pub use crate::numeric::dense::*;
    }
    /// Inner parts of `eigenvalues`.
    pub mod eigenvalues {
        pub use crate::numeric::eigenvalues::*;
    }
    /// Inner parts of `envelope`.
    pub mod envelope {
        pub use crate::numeric::envelope::*;
    }
    /// Inner parts of `event`.
    pub mod event {
        pub use crate::numeric::event::*;
    }
    /// Inner parts of `noise`.
    pub mod noise {
        pub use crate::numeric::noise::*;
    }
    /// Inner parts of `pattern`.
    pub mod pattern {
        pub use crate::numeric::pattern::*;
    }
    /// Inner parts of `quadrature`.
    pub mod quadrature {
        pub use crate::numeric::quadrature::*;
    }
    /// Inner parts of `radau`.
    pub mod radau {
        pub use crate::numeric::radau::*;
    }
    /// Inner parts of `rank`.
    pub mod rank {
        pub use crate::numeric::rank::*;
    }
    /// Inner parts of `runge_kutta`.
    pub mod runge_kutta {
        pub use crate::numeric::runge_kutta::*;
    }
    /// Inner parts of `sparse`.
    pub mod sparse {
        pub use crate::numeric::sparse::*;
    }
    /// Inner parts of `subdivision`.
    pub mod subdivision {
        pub use crate::numeric::subdivision::*;
    }
}
/// Inner parts of `results`.
#[cfg(feature = "solver")]
pub mod results {
    /// Inner parts of `kept`.
    pub mod kept {
        pub use crate::results::kept::*;
    }
    /// Inner parts of `output_folder`.
    pub mod output_folder {
        pub use crate::results::output_folder::*;
    }
}
/// Inner parts of `verify`.
#[cfg(feature = "solver")]
pub mod verify {
    /// Inner parts of `outline`.
    pub mod outline {
        pub use crate::analysis::verify::outline::*;
    }
    /// Inner parts of `idle`.
    pub mod idle {
        pub use crate::analysis::verify::idle::*;
    }
}
