//! Has the linker export from the program `cognate` the functions that routines of a library call,
//! and no others: a library that is linked by `gfortran -shared` alone finds them there.

/// The names of `src/routines/services.rs`, without those of C.
const SERVICES: [&str; 6] = ["sysfnc", "sysary", "syspar", "errmes", "usrmes", "timget"];

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |name: &str, value: &str| std::env::var(name).is_ok_and(|v| v == value);
    if std::env::var_os("CARGO_FEATURE_ROUTINES").is_none()
        || !is("CARGO_CFG_TARGET_FAMILY", "unix")
    {
        return;
    }
    let is_apple = is("CARGO_CFG_TARGET_VENDOR", "apple");
    for service in SERVICES {
        for name in [format!("{service}_"), format!("c_{service}")] {
            let word = match is_apple {
                true => format!("-Wl,-exported_symbol,_{name}"),
                false => format!("-Wl,--export-dynamic-symbol={name}"),
            };
            println!("cargo:rustc-link-arg-bins={word}");
        }
    }
}
