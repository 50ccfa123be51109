#include <algorithm>
#include <array>
#include <cstdint>

#include "render/canvas.hpp"
#include "scenarios/exchange/model.hpp"

namespace lrb::exchange {
namespace {

/// The order in which VTK numbers the cells of polygonal data.
constexpr std::array kOrder = {Shape::points, Shape::lines, Shape::polygons};

template <class T>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<T, double>)
    return "Float64";
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return "Int64";
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return "Int32";
  else
    return "UInt8";
}

class VtpOut {
 public:
  explicit VtpOut(const Model& model) : model_(model) {}

  std::string write() {
    line("<?xml version=\"1.0\"?>");
    line("<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">");
    line("<!-- kind: 0 pseudo face, 1 real face, 2 contact; -1: does not apply -->");
    line("<PolyData>");
    piece();
    line("</PolyData>");
    line("</VTKFile>");
    return std::move(text_);
  }

 private:
  void piece() {
    std::size_t points = 0;
    for (const Part& part : model_.parts) points += part.vertices.size();
    const auto cells = [&](Shape shape) {
      std::size_t out = 0;
      for (const Part& part : model_.parts) out += part.shape == shape ? part.cell_count() : 0;
      return "\"" + std::to_string(out) + "\"";
    };
    line("<Piece NumberOfPoints=\"" + std::to_string(points) + "\" NumberOfVerts=" + cells(Shape::points) +
         " NumberOfLines=" + cells(Shape::lines) +
         " NumberOfStrips=\"0\" NumberOfPolys=" + cells(Shape::polygons) + ">");
    line("<CellData Scalars=\"" + std::string(model_.quality) + "\">");
    colours();
    for (std::size_t i = 0; i < model_.columns.size(); ++i) column(i);
    line("</CellData>");
    std::vector<double> x;
    for (const Part& part : model_.parts)
      for (const Eigen::Vector3d& v : part.vertices) x.insert(x.end(), v.begin(), v.end());
    line("<Points>");
    array("Points", x, 3);
    line("</Points>");
    cells_of(Shape::points, "Verts");
    cells_of(Shape::lines, "Lines");
    cells_of(Shape::polygons, "Polys");
    line("</Piece>");
  }

  void colours() {
    std::vector<std::uint8_t> out;
    for (const Shape shape : kOrder)
      for (const Part& part : model_.parts)
        for (std::size_t c = 0; c < part.cell_count() && part.shape == shape; ++c)
          for (const std::uint8_t x :
               {part.colours[c].r, part.colours[c].g, part.colours[c].b, part.colours[c].a})
            out.push_back(x);
    array("colour", out, 4);
  }

  void column(std::size_t i) {
    std::vector<double> out;
    for (const Shape shape : kOrder)
      for (const Part& part : model_.parts)
        if (part.shape == shape) out.insert(out.end(), part.values[i].begin(), part.values[i].end());
    const std::string_view name = model_.columns[i].name;
    if (!model_.columns[i].whole) return array(name, out, 1);
    array(name, std::vector<std::int32_t>(out.begin(), out.end()), 1);
  }

  void cells_of(Shape shape, const std::string& element) {
    std::vector<std::int64_t> connectivity, offsets;
    std::int64_t first = 0;
    for (const Part& part : model_.parts) {
      for (std::size_t c = 0; c < part.cell_count() && part.shape == shape; ++c) {
        for (const std::uint32_t v : part.cell(c)) connectivity.push_back(first + v);
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
      }
      first += static_cast<std::int64_t>(part.vertices.size());
    }
    line("<" + element + ">");
    array("connectivity", connectivity, 1);
    array("offsets", offsets, 1);
    line("</" + element + ">");
  }

  template <class T>
  void array(std::string_view name, const std::vector<T>& values, int components) {
    line(std::string("<DataArray type=\"") + type_name<T>() + "\" Name=\"" +
         render::escape_markup(std::string(name)) + "\" NumberOfComponents=\"" + std::to_string(components) +
         "\" format=\"binary\">");
    line(as_base64(values));
    line("</DataArray>");
  }

  /// The number of bytes, followed by the bytes.
  template <class T>
  static std::string as_base64(const std::vector<T>& values) {
    std::string bytes;
    append(bytes, std::uint64_t{values.size() * sizeof(T)});
    for (const T x : values) append(bytes, x);
    return render::base64(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }

  void line(std::string_view words) { text_.append(words).append("\n"); }

  const Model& model_;
  std::string text_;
};

}  // namespace

std::string vtp_bytes(const Model& model) {
  return VtpOut(model).write();
}

}  // namespace lrb::exchange
