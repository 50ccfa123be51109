#pragma once
/// Writes captures as a program with lrbscope_capture.h does.

#include <string>

#include <lrbscope/trace/capture.hpp>

namespace lrb::test {

/// Writes meshes, trees, names and queries of a capture. Trees and events must name nodes by index.
void write_capture(const capture::Capture& capture, const std::string& path);

}  // namespace lrb::test
