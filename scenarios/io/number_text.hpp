#pragma once
/// Numbers as text, the same whatever the locale.

#include <string>

namespace lrb::io {

/// Returns a number with this many significant digits at most, as printf's %g has it.
std::string number_text(double x, int digits = 7);

/// Returns a number with this many decimals at most: no exponent, no zeros at the end.
std::string fixed_text(double x, int decimals = 6);

}  // namespace lrb::io
