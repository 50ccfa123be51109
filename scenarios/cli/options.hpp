#pragma once
/// Options that several commands have.

#include <CLI/CLI.hpp>

#include "engine/build/build.hpp"
#include "engine/query/collide.hpp"

namespace lrb::cli {

/// --mode and --recursion.
void add_request_options(CLI::App& app, CollideRequest& request);
/// --patch, --max-outer and --seed.
void add_build_options(CLI::App& app, BuildOptions& options);

}  // namespace lrb::cli
