#include "bench/levels/free_simplification.hpp"

#include <cstdio>
#include <memory>
#include <sstream>
#include <string>

#include "bench/rivals/triangles.hpp"
#include "bench/workers/child.hpp"
#include "bench/workers/workers.hpp"
#include <lrbscope/core/strings.hpp>

namespace lrb::levels {
namespace {

/// Returns the real triangles as OFF.
std::string off_text(const LrbRep& rep) {
  constexpr int kAllDigits = 17;
  const Mesh mesh = methods::real_mesh(rep);
  std::ostringstream out;
  out << "OFF\n" << mesh.vertices.size() << " " << rep.real_simplex_count() << " 0\n";
  for (const Eigen::Vector3d& v : mesh.vertices)
    out << io::number_text(v.x(), kAllDigits) << " " << io::number_text(v.y(), kAllDigits) << " "
        << io::number_text(v.z(), kAllDigits) << "\n";
  for (FaceId f = 0; f < mesh.face_count(); ++f)
    for (std::size_t i = 1; i + 1 < mesh.face(f).size(); ++i)
      out << "3 " << mesh.face(f)[0].value() << " " << mesh.face(f)[i].value() << " "
          << mesh.face(f)[i + 1].value() << "\n";
  return out.str();
}

}  // namespace

std::vector<FreeMesh> simplify_freely(const LrbRep& rep, std::span<const std::uint32_t> face_counts) {
  constexpr std::chrono::seconds kLimit(600);
  const std::string program = workers::program_beside("lrbscope-simplify");
  if (program.empty() || rep.dim() != 3) return {};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> mesh(std::tmpfile(), &std::fclose);
  const std::string text = off_text(rep);
  if (!mesh || std::fputs(text.c_str(), mesh.get()) < 0 || std::fflush(mesh.get()) != 0) return {};
  std::vector<std::string> command = {program};
  for (const std::uint32_t n : face_counts) command.push_back(std::to_string(n));
  std::vector<FreeMesh> out;
  for (const std::string& line : workers::lines_of(command, kLimit, fileno(mesh.get()))) {
    FreeMesh m{};
    if (std::istringstream(line) >> m.faces >> m.to_body >> m.from_body) out.push_back(m);
  }
  return out;
}

}  // namespace lrb::levels
