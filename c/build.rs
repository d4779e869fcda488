//! Gives the shared library the name by which programs look for it: libcognate.so.0 holds the
//! first number of the version, so that an incompatible one can stand beside it.

fn main() {
    let system = std::env::var("CARGO_CFG_TARGET_OS").unwrap_or_default();
    let major = std::env::var("CARGO_PKG_VERSION_MAJOR").unwrap_or_default();
    match system.as_str() {
        "macos" | "ios" => {
            let name = format!("@rpath/libcognate.{major}.dylib");
            println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,{name}");
        }
        "windows" | "emscripten" | "wasi" => {}
        _ => println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libcognate.so.{major}"),
    }
    println!("cargo:rerun-if-changed=build.rs");
}
