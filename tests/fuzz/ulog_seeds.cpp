// SPDX-License-Identifier: MIT
// Writes sound ULog files of every kind of message into a folder, for the fuzzer to begin with: ulog_seeds DIR
#include <string>

#include "fuzz/seeds.hpp"
#include "programs/logs/ulog_bytes.hpp"

int main(int argument_count, char** arguments) {
  using pinnquad_test::Bytes;
  using pinnquad_test::UlogBytes;
  UlogBytes usual;
  usual.flags(1, 0).keyed('I', "char[3] sys_name", Bytes().text("PX4")).keyed('I', "uint32_t ver", Bytes().u32(2));
  usual.format("a:uint64_t timestamp;float[3] x;bool b;uint8_t[3] _padding0;").format("b:uint64_t timestamp;double y;");
  usual.keyed('P', "float MASS", Bytes().f32(1)).keyed('P', "int32_t N", Bytes().u32(4));
  usual.message('M', Bytes().u8(0).u8(9).text("char[2] m").text("ab").str());
  usual.message('Q', Bytes().u8(1).u8(10).text("float MASS").f32(1).str());
  usual.topic(0, 0, "a").topic(1, 1, "a").topic(0, 2, "b");
  for (unsigned i = 0; i < 9; ++i) {
    if (i % 3 == 2) usual.data(2, Bytes().u64(1000 * i).f64(0.5 * i)).sync();
    if (i % 3 != 2) usual.data(i % 3, Bytes().u64(1000 * i).f32(1).f32(2).f32(3).u8(1));
  }
  usual.said('6', 5, "armed").message('C', Bytes().text("3").u16(9).u64(8).text("tagged").str()).dropout(20);
  usual.keyed('P', "float MASS", Bytes().f32(2)).message('R', Bytes().u16(1).str()).data(2, Bytes().u64(9).f64(1));
  UlogBytes nested(0);
  nested.format("o:uint64_t timestamp;i[2] e;uint8_t[2] _padding0;char[5] s;")
      .format("i:p[2] q;uint16_t r;")
      .format("p:int8_t x;int64_t y;");
  nested.topic(3, 500, "o");
  for (unsigned i = 0; i < 3; ++i) nested.data(500, Bytes().u64(i).zeros(2 * (2 * 9 + 2) + 2).text("hello"));
  const auto appended = [](std::uint64_t offset) {
    UlogBytes file;
    file.flags(0, 1, {offset}).format("a:uint64_t timestamp;float x;").topic(0, 0, "a").data(0, Bytes().u64(1).f32(1));
    return file.raw("\x20\1");
  };
  return pinnquad_test::write_seeds(
      argument_count, arguments,
      {usual.str(), nested.str(), appended(appended(0).str().size()).data(0, Bytes().u64(2).f32(2)).str()});
}
