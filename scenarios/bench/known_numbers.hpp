#pragma once

#include "scenarios/bench/data_set.hpp"

namespace lrb::bench {

/// Fills in the numbers that a data set asks for: our own intervals at their narrowest, as the worker of
/// methods that answer with a number finds them. Throws EnvironmentError if that is not there, and
/// InputError, which names the question, for one that has no answer.
void find_numbers(DataSet& set);

}  // namespace lrb::bench
