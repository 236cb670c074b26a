"""Numbers of this room that were found by trial: what each one is, what it was calibrated on, and the test that holds it."""

from lagrotor.numerics.calibrated import Calibrated

LONGEST_RUN = Calibrated(
    2.0,
    "s of one run, after which a method is not run at a finer setting; up to a tenth of it runs are repeated",
    "all methods on four scenes: the slowest, implicit ones take minutes at 1e-13",
    "test_runner.py::test_a_method_that_takes_long_is_not_run_at_finer_settings",
)
LONGEST_QUICK_RUN = Calibrated(
    0.2,
    "the same of `lagrotor chart --quick`",
    "all methods on four scenes: the whole then takes about half a minute",
    "test_scenes_and_methods.py::test_what_is_left_out_is_listed",
)
SAMPLE = Calibrated(
    0.01,
    "s for which a run is repeated to time it: one of a millisecond by itself depends on what ran before it",
    "the minimal model, whose runs take 3 to 30 ms: ten samples of it agree to 5 %",
    "test_runner.py::test_a_short_run_is_repeated_until_a_sample_is_full_and_a_long_one_is_not",
)
LSODA_LEAST = Calibrated(
    3e-14,
    "tolerance below which LSODA does not start",
    "scipy's odeint and ode",
    "test_limits.py::test_solvers_keep_an_orbit",
)
