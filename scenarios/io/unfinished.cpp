#include "scenarios/io/unfinished.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "scenarios/io/files.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::io {
namespace {

/// Returns the lines of a file that end with a line break; the last one may have been cut off.
std::vector<std::string> complete_lines(const std::string& path) {
  std::vector<std::string> out;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return out;
  const std::string text = read_text(path);
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    out.push_back(text.substr(begin, end - begin));
  return out;
}

}  // namespace

void LineAppender::add(const std::string& line) {
  if (!(out_ << line << "\n" << std::flush))
    throw EnvironmentError(printable_name(path_) + ": cannot write the file: " + std::strerror(errno));
}

UnfinishedFile::UnfinishedFile(std::string path, const std::string& head, Other other)
    : path_(std::move(path)) {
  if (path_.empty()) return;
  lines_ = complete_lines(path_);
  if (other == Other::refused && !lines_.empty() && lines_.front() != head)
    throw InputError(
        printable_name(path_) +
        ": belongs to an interrupted run with other settings or of another version; finish that run, "
        "remove the file, or give another folder (-o)");
  if (lines_.empty() || lines_.front() != head)
    lines_.clear();
  else
    lines_.erase(lines_.begin());
  std::string text = head + "\n";
  for (const std::string& line : lines_) text += line + "\n";
  write_text(path_, text);  // without a line that was cut off
  out_.emplace(path_);
}

void UnfinishedFile::add(const std::string& line) {
  if (out_) out_->add(line);
}

void UnfinishedFile::remove() const {
  std::error_code error;
  if (!path_.empty()) std::filesystem::remove(path_, error);
}

}  // namespace lrb::io
