#pragma once
/// What becomes of a question that a method refuses, or that ends in an exception.

#include <exception>
#include <string>

#include "engine/core/error.hpp"

namespace lrb::workers {

/// Calls ask(). Notes an InputError in the record as a refusal, and any other exception as a crash, with what
/// it says. Record: has a `message`, and an `outcome` that may be refused or crashed.
template <class Record, class Ask>
void note_failures(Record& record, Ask ask) {
  using Outcome = decltype(record.outcome);
  try {
    ask();
  } catch (const InputError& e) {
    record.outcome = Outcome::refused;
    record.message = e.what();
  } catch (const std::exception& e) {
    record.outcome = Outcome::crashed;
    record.message = std::string("threw an exception: ") + e.what();
  }
}

}  // namespace lrb::workers
