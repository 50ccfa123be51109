#pragma once
/// The worker: a program beside lrbscope that puts cases to methods whose code lrbscope does not contain, and
/// that may crash or hang.
///
/// It writes everything as JSON lines to stdout:
///   --list                the methods it has
///   --family F --seed S --cases N --begin K --end L
///                         the right answers (RightAnswer) to cases K .. L - 1; case k is number k % N at
///                         setting k / N of the dial
///   ... --method M [--expected FILE] [--pairs]
///                         a record for each; the right answers are read from the file's lines, the first of
///                         which is case 0's, or found here; with --pairs the lists as well
///   --questions FILE --method M [--setting X] [--pairs] --begin K --end L
///                         a bench::Record for each of a data set's questions K .. L - 1
/// Exit codes: 0, or 2 with the line {"error": "..."}.

#include <vector>

#include "scenarios/methods/method.hpp"

namespace lrb::worker_programs {

int worker_main(int argc, char** argv, std::vector<methods::MethodEntry> entries);

}  // namespace lrb::worker_programs
