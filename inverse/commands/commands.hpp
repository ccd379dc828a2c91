#pragma once

#include <CLI/CLI.hpp>

namespace kerf::commands {

/// One subcommand per file. Each adds itself to the application and, when parsed, stores in `exit_code` what the
/// process returns; results go to standard output, progress to standard error, errors are thrown (see
/// models/base/error.hpp).
void add_predict(CLI::App& app, int& exit_code);
void add_reduce(CLI::App& app, int& exit_code);
void add_r_curve(CLI::App& app, int& exit_code);
void add_simulate(CLI::App& app, int& exit_code);
void add_explain(CLI::App& app, int& exit_code);
void add_check(CLI::App& app, int& exit_code);
void add_list(CLI::App& app, int& exit_code);
void add_sweep(CLI::App& app, int& exit_code);
void add_study(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_coverage(CLI::App& app, int& exit_code);
void add_next_cut(CLI::App& app, int& exit_code);
void add_resume(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_evaluate(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);

}  // namespace kerf::commands
