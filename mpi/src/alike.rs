//! The check that all ranks compute alike.
//!
//! Values that every rank computes for itself must have the same digits everywhere.

use rc_comm::Ranks;

/// The features of the processor that select the code paths of sums and transforms.
fn processor() -> String {
    #[cfg(target_arch = "x86_64")]
    let features = format!(
        "sse4.1 {} avx {} fma {} avx2 {} avx512f {}",
        is_x86_feature_detected!("sse4.1"),
        is_x86_feature_detected!("avx"),
        is_x86_feature_detected!("fma"),
        is_x86_feature_detected!("avx2"),
        is_x86_feature_detected!("avx512f")
    );
    #[cfg(not(target_arch = "x86_64"))]
    let features = std::env::consts::ARCH.to_owned();
    // Without vector instructions all processors compute alike.
    let chosen = std::env::var("RC_SIMD").unwrap_or_default();
    let features = if chosen == "scalar" { String::new() } else { features };
    format!("rc {} {features} {chosen}", env!("CARGO_PKG_VERSION"))
}

/// Refuses ranks of different versions of rc or with different vector instructions.
pub(crate) fn check(ranks: &Ranks) -> Result<(), String> {
    let all = ranks.all_gather(processor().as_bytes());
    match all.iter().position(|other| *other != all[0]) {
        None => Ok(()),
        Some(rank) => Err(format!(
            "MPI: ranks 0 and {rank} are other versions of rc, or on processors with other vector instructions, and would not compute the same \
             digits; use nodes of one kind, or set RC_SIMD=scalar on all of them"
        )),
    }
}
