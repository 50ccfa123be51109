#pragma once
/// The paper's figures 3.1 and 3.2, from the records, for print.

#include "scenarios/paper/tables.hpp"
#include "scenarios/report/charts/gnuplot.hpp"

namespace lrb::paper {

/// Figure 3.1: size of the other object (real and pseudo faces, log axis) against comparisons: minimum,
/// average and maximum, measured with the paper's recursion and as published.
report::Gnuplot figure_3_1(std::span<const ObjectRow> rows);

/// Figure 3.2: how often so many comparisons were needed, a line for each object, with the paper's recursion.
report::Gnuplot figure_3_2(std::span<const ObjectRow> rows, std::span<const ContactStep> steps);

}  // namespace lrb::paper
