#include <doctest/doctest.h>

#include "scenarios/report/document.hpp"

using lrb::report::in_columns;
using Rows = std::vector<std::vector<std::string>>;

TEST_CASE("columns are as wide as their longest cell; remarks at the end of a row do not widen them") {
  CHECK(in_columns(Rows{{"name", "n"}, {"a", "12"}, {"long", "3"}}) == "name   n\na     12\nlong   3\n");
  CHECK(in_columns(Rows{{"a", "b"}, {"xyz", "w"}}, 2) == "a    b\nxyz  w\n");
  CHECK(in_columns(Rows{{"a", "b"}, {"x", "1", "not exact"}}) == "a  b\nx  1  not exact\n");
  CHECK(in_columns(Rows{{"a", "b", "c"}, {"x", "not measured"}}, 0) == "a  b  c\nx  not measured\n");
}
