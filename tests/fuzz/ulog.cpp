// SPDX-License-Identifier: MIT
// libFuzzer target over the reader of ULog files: whatever the bytes, there is a log whose columns are as long as its
// clock, with what was lost said in one line each, or one line that says what is wrong. The mutator works on whole
// messages: chance would break their sizes. Build and run: scripts/heavy/fuzz.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/fuzzing.hpp"
#include "fuzz/log_rules.hpp"
#include "logs/ulog.hpp"
#include "pinnquad/io/file_error.hpp"

namespace {

using pinnquad::logs::FlightLog;
using pinnquad::logs::LogTopic;
using pinnquad_test::expect;

pinnquad_test::Tally tally;

void check(const FlightLog& log, std::size_t size) {
  pinnquad_test::expect_sound(log, size);
  for (const LogTopic& topic : log.topics) expect(topic.column("timestamp") != nullptr, "a topic has its clock");
}

/// A topic read alone is as it was among the others.
void check_selection(const FlightLog& log, std::string_view bytes) {
  pinnquad::logs::LogSelection selection;
  selection.topics = {log.topics.back().name};
  const FlightLog alone = pinnquad::logs::parse_ulog(bytes, "x.ulg", selection);
  for (const LogTopic& topic : alone.topics) {
    const LogTopic* const same = log.topic(topic.name, topic.instance);
    expect(same != nullptr && same->place == topic.place && same->columns.size() == topic.columns.size(),
           "a topic is the same alone");
  }
}

struct Span {
  std::size_t begin, size;
};

std::vector<Span> messages(const std::uint8_t* data, std::size_t size) {
  std::vector<Span> result;
  for (std::size_t place = 16; place + 3 <= size;) {
    const std::size_t length = 3u + data[place] + 256u * data[place + 1];
    if (length > size - place) break;
    result.push_back({place, length});
    place += length;
  }
  return result;
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned int seed) {
  std::minstd_rand engine(seed);
  const std::vector<Span> all = messages(data, size);
  const auto any = [&] { return all[engine() % all.size()]; };
  const unsigned way = all.empty() ? 0 : engine() % 8;
  if (way < 2) {
    size = LLVMFuzzerMutate(data, size, most);
  } else if (way < 6) {  // one message, which keeps its type and has the right size
    const Span span = any();
    const std::size_t content = span.size - 3, behind = size - span.begin - span.size;
    std::vector<std::uint8_t> changed(std::min<std::size_t>(content + 64, 60000));
    std::memcpy(changed.data(), data + span.begin + 3, content);
    const std::size_t now = LLVMFuzzerMutate(changed.data(), content, changed.size());
    if (size - content + now > most) return size;
    std::memmove(data + span.begin + 3 + now, data + span.begin + span.size, behind);
    std::memcpy(data + span.begin + 3, changed.data(), now);
    data[span.begin] = static_cast<std::uint8_t>(now % 256);
    data[span.begin + 1] = static_cast<std::uint8_t>(now / 256);
    size = size - content + now;
  } else if (way == 6) {  // one once more, elsewhere
    const Span span = any(), before = any();
    if (size + span.size > most) return size;
    const std::vector<std::uint8_t> copy(data + span.begin, data + span.begin + span.size);
    std::memmove(data + before.begin + copy.size(), data + before.begin, size - before.begin);
    std::memcpy(data + before.begin, copy.data(), copy.size());
    size += copy.size();
  } else {
    const Span span = any();
    std::memmove(data + span.begin, data + span.begin + span.size, size - span.begin - span.size);
    size -= span.size;
  }
  if (size >= 16 && engine() % 16 != 0) std::memcpy(data, "ULog\x01\x12\x35", 7);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<char> memory(data, data + size);  // of its own: the sanitizer sees a read past the end
  const std::string_view bytes(memory.data(), memory.size());
  try {
    const FlightLog log = pinnquad::logs::parse_ulog(bytes, "x.ulg");
    check(log, size);
    if (!log.topics.empty()) check_selection(log, bytes);
    ++tally.count[log.topics.empty() ? "no row" : log.warnings.empty() ? "ok" : "with a warning"];
  } catch (const pinnquad::InputError& error) {
    pinnquad_test::expect_one_line(error.what());
    ++tally.count["refused"];
  }
  return 0;
}
