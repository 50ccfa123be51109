#pragma once
/// What fuzzers and the mutation test feed bytes to: one function per format that a stranger's file can have.
/// Each reads the bytes as its format and, if they are accepted, uses the result. An InputError is the right
/// answer to bad bytes, provided that it is one line that begins with the file's name; anything else (another
/// exception, a bad message, a reader that contradicts its writer) ends the process by throwing.

#include <string>
#include <string_view>

namespace lrb::fuzz {

/// The first byte chooses the extension of the name, the rest are the file.
bool feed_mesh(std::string_view bytes);
/// The lowest bit of the first byte decides whether the checksum is corrected, without which nearly every
/// mutation would stop at it; the rest are the file.
bool feed_lrb(std::string_view bytes);
/// Four edits of five bytes each say which fields of a good file are damaged; the first byte chooses the
/// file. Its checksum is corrected, and accepted files go through every reader.
bool feed_fields(std::string_view bytes);
/// The first byte: '0', and the rest is an OBJ, or '1' or '2', and the rest says how a body's polygons fold.
/// It is built, proved, saved, loaded and queried.
bool feed_body(std::string_view bytes);
bool feed_poses(std::string_view bytes);
bool feed_scenario(std::string_view bytes);
bool feed_crowd(std::string_view bytes);
bool feed_experiment(std::string_view bytes);
bool feed_trace(std::string_view bytes);
/// The first byte, if below 8, limits the queries that are read; the rest is the file.
bool feed_capture(std::string_view bytes);
/// The first byte chooses the query: two in four a first contact, one a distance, one a clash; with 64 in the
/// plane; with 128 of a body and itself. The rest choose bodies, poses, motions and tolerances.
bool feed_motion(std::string_view bytes);

/// Throws std::logic_error unless an InputError's message is one line that begins with `name` and a colon.
void judge_message(std::string_view message, std::string_view name);

/// Runs `read`, which throws InputError for bad bytes. Returns whether they were accepted.
template <class Read>
bool accepted(std::string_view name, const Read& read);

}  // namespace lrb::fuzz

#include "tests/fuzz/feed.inl"
