#pragma once
/// The inputs of a program, which its outputs must not replace. A library has none: its caller may read a
/// file and write it again.

#include <string>

namespace lrb {

/// Makes AtomicFile refuse to replace a file that exists, under any of its names. Call it before any thread.
void protect_input(const std::string& path);
/// Throws InputError if a path is a protected file.
void reject_input_as_output(const std::string& path);

}  // namespace lrb
