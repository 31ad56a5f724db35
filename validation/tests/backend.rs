//! Cases on a GPU report that they ran there, and their figures are those of the CPU.
//!
//! `cargo test -p sorb-validation --features gpu --test backend` compares; without the feature, a GPU is refused.

use sorb::{Offload, Options};
use sorb_validation::{CASES, Outcome, Setting, run};

/// A quick case on a backend.
fn outcome(name: &str, offload: Offload, fault: bool) -> Outcome {
    let case = CASES.iter().find(|case| case.name == name).unwrap_or_else(|| panic!("no case {name}"));
    let options = Options { offload, ..Options::default() };
    run(case, &Setting { quick: true, resolution: 0.5, fault, options, ..Setting::new() })
}

#[test]
fn a_case_on_the_cpu_says_so() {
    let outcome = outcome("patch", Offload::Cpu, false);
    assert!(outcome.figures.is_ok());
    assert_eq!((outcome.backends.names().as_str(), outcome.backends.reasons().as_str()), ("cpu", ""));
}

#[cfg(not(feature = "gpu"))]
#[test]
fn a_gpu_without_the_feature_is_a_failure_that_names_it() {
    let outcome = outcome("patch", Offload::Gpu, false);
    assert_eq!(outcome.backends.names(), "");
    let error = outcome.figures.expect_err("built without the feature").to_string();
    assert!(error.contains("feature `gpu`"), "{error}");
}

/// Errors of a case on the CPU and on a GPU, with backends and reasons of the second.
#[cfg(feature = "gpu")]
fn both(name: &str, fault: bool) -> (Vec<[f64; 2]>, String, String) {
    let cpu = outcome(name, Offload::Cpu, false);
    let gpu = outcome(name, Offload::Gpu, fault);
    let said = (gpu.backends.names(), gpu.backends.reasons());
    let [cpu, gpu] =
        [cpu, gpu].map(|outcome| outcome.figures.unwrap_or_else(|error| panic!("{name}: {error}")));
    let errors = cpu.iter().zip(&gpu).map(|(cpu, gpu)| [cpu.error / cpu.bound, gpu.error / cpu.bound]);
    (errors.collect(), said.0, said.1)
}

/// Errors over their bounds are alike: a dam of some hundred particles before it splashes, and a sponge.
#[cfg(feature = "gpu")]
#[test]
fn figures_on_a_gpu_are_those_of_the_cpu() {
    let differ = |errors: &[[f64; 2]]| errors.iter().any(|[cpu, gpu]| (cpu - gpu).abs() > 0.05);
    for name in ["dam_break", "uniaxial"] {
        let (errors, backend, adapter) = both(name, false);
        assert_eq!(backend, "gpu", "{name}");
        assert!(!adapter.is_empty() && !differ(&errors), "{name} on {adapter}: {errors:?}");
        // Negative control: the planted fault of the case, on the GPU alone.
        let (errors, ..) = both(name, true);
        assert!(differ(&errors), "{name}: {errors:?}");
    }
}
