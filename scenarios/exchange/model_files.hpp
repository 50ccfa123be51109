#pragma once
/// Writes models in the formats of other programs. docs/formats.md tells what each holds.

#include <string>

#include "scenarios/exchange/model.hpp"

namespace lrb::exchange {

struct FileOptions {
  bool ascii = false;    ///< numbers as text: PLY, VTP
  bool regions = false;  ///< a group or node for each region: OBJ, GLB
  int up = 2;            ///< the axis of the model that points up, for GLB, in which y does
};

/// Return the bytes of a file.
std::string ply_bytes(const Model& model, const FileOptions& options);
std::string vtp_bytes(const Model& model, const FileOptions& options);
std::string obj_bytes(const Model& model, const FileOptions& options);
std::string glb_bytes(const Model& model, const FileOptions& options);

/// Writes a model to FILE.ply, .vtp, .obj or .glb, whole or not at all. Throws InputError for other names,
/// and for options that the format does not know.
void save_model(const Model& model, const std::string& path, const FileOptions& options);
/// Throws as save_model() does, before there is a model.
void check_model_file(const std::string& path, const FileOptions& options);

}  // namespace lrb::exchange
