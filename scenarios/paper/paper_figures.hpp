#pragma once
/// The paper's figures 3.1 and 3.2, from the records, for print.

#include "scenarios/paper/tables.hpp"
#include "scenarios/report/gnuplot.hpp"

namespace lrb::paper {

/// Makes figure 3.1: the other object's size (real and pseudo faces, log axis) against comparisons: minimum,
/// average and maximum, measured with the paper's recursion and as published.
report::Gnuplot figure_3_1(std::span<const ObjectRow> rows);

/// Makes figure 3.2: for each number of comparisons, how many time steps needed it, a line for each object,
/// with the paper's recursion.
report::Gnuplot figure_3_2(std::span<const ObjectRow> rows, std::span<const ContactStep> steps);

}  // namespace lrb::paper
