#pragma once

#include <stdexcept>
#include <string>

#include <zlib.h>

namespace lrb::test {

/// Returns the bytes of a PDF, followed by its object streams, decompressed. Cairo 1.18 puts page sizes and
/// metadata into such streams, which 1.16 writes as they are. Throws if a stream is damaged.
inline std::string pdf_text(const std::string& pdf) {
  std::string out = pdf;
  const std::string begin = "stream\n";
  for (std::size_t at = pdf.find("/ObjStm"); at != std::string::npos; at = pdf.find("/ObjStm", at + 1)) {
    const std::size_t data = pdf.find(begin, at);
    if (data == std::string::npos)
      throw std::runtime_error("a PDF names an object stream that it does not have");
    std::string copy = pdf.substr(data + begin.size());
    z_stream z{};
    if (inflateInit(&z) != Z_OK) throw std::runtime_error("zlib cannot be used");
    z.next_in = reinterpret_cast<Bytef*>(copy.data());
    z.avail_in = static_cast<uInt>(copy.size());
    int state = Z_OK;
    while (state == Z_OK) {  // ends: each round but the last consumes input or fills the buffer
      char buffer[4096];
      z.next_out = reinterpret_cast<Bytef*>(buffer);
      z.avail_out = sizeof buffer;
      state = inflate(&z, Z_NO_FLUSH);
      out.append(buffer, sizeof buffer - z.avail_out);
    }
    inflateEnd(&z);
    if (state != Z_STREAM_END) throw std::runtime_error("an object stream of a PDF is damaged");
  }
  return out;
}

}  // namespace lrb::test
