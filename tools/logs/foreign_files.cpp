// SPDX-License-Identifier: MIT
#include "logs/foreign_files.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "pinnquad/io/file_error.hpp"

namespace pinnquad::logs {
namespace {

struct Container {
  std::string_view magic;
  const char* words;  ///< what it is, and how to get at the log
};

constexpr std::array<Container, 19> containers{{
    {{"\xfd"
      "7zXZ\0",
      6},
     "one compressed by xz (restore it with xz -d)"},
    {{"\x1f\x8b", 2}, "one compressed by gzip (restore it with gzip -d)"},
    {{"\x28\xb5\x2f\xfd", 4}, "one compressed by zstd (restore it with zstd -d)"},
    {{"BZh", 3}, "one compressed by bzip2 (restore it with bzip2 -d)"},
    {{"7z\xbc\xaf\x27\x1c", 6}, "one compressed by 7z (restore it with 7z x)"},
    {{"\x89MCAP0\r\n", 8},
     "an MCAP file (a table of a topic: ros2 bag play -s mcap FILE, and ros2 topic echo --csv /TOPIC > topic.csv)"},
    {{"#ROSBAG V", 9}, "a ROS 1 bag (a table of a topic: rostopic echo -b FILE -p /TOPIC > topic.csv)"},
    {{"SQLite format 3\0", 16},
     "an SQLite file, as a ROS 2 bag is (a table of a topic: ros2 bag play FOLDER, and ros2 topic echo --csv /TOPIC > "
     "topic.csv)"},
    {{"\x89HDF\r\n\x1a\n", 8},
     "an HDF5 file or MATLAB's of version 7.3 (a table: pandas.DataFrame(h5py.File(FILE)[NAME][()]).to_csv('log.csv'), "
     "with [()].T for MATLAB's, which is transposed)"},
    {{"MATLAB 5.0 MAT-file", 19}, "a MATLAB file (a table: writetable(T, 'log.csv') in MATLAB)"},
    {{"\x93NUMPY", 6},
     "a NumPy array (a table: numpy.savetxt('log.csv', numpy.load(FILE), delimiter=','), with a header)"},
    {{"PAR1", 4}, "a Parquet table (pandas.read_parquet(FILE).to_csv('log.csv', index=False))"},
    {{"\x80\x02", 2}, "a Python pickle, as old PyTorch files are: a network, not a log (pinnquad convert)"},
    {{"{\"", 2},
     "JSON (a table, of an object a line: pandas.read_json(FILE, lines=True, convert_dates=False).to_csv('log.csv', "
     "index=False))"},
    {{"\xff\xfe", 2}, "text in UTF-16 (make it UTF-8: iconv -f UTF-16 -t UTF-8 FILE > log.csv)"},
    {{"\xfe\xff", 2}, "text in UTF-16 (make it UTF-8: iconv -f UTF-16 -t UTF-8 FILE > log.csv)"},
    {{"FMT, 128, 89", 12}, "a DataFlash log as text (give the .bin of the vehicle)"},
    {{"<?xml", 5}, "an XML file, as a layout of PlotJuggler is, which holds no data (export the data as CSV there)"},
    {{"<root", 5}, "an XML file, as a layout of PlotJuggler is, which holds no data (export the data as CSV there)"},
}};

/// Eight bytes of microseconds since 1970, the highest first, before each MAVLink message.
bool is_telemetry(std::string_view begin) {
  constexpr std::uint64_t us_2000 = 946'684'800'000'000, us_2100 = 4'102'444'800'000'000;
  if (begin.size() < 9) return false;
  std::uint64_t time = 0;
  for (std::size_t i = 0; i < 8; ++i) time = time << 8 | static_cast<unsigned char>(begin[i]);
  const auto marker = static_cast<unsigned char>(begin[8]);
  return (marker == 0xfd || marker == 0xfe) && time > us_2000 && time < us_2100;
}

}  // namespace

void refuse_foreign(const std::string& path, std::string_view begin) {
  const auto refuse = [&path](const char* words) { throw InputError(path, 0, 0, "a log as it was written", words); };
  for (const Container& container : containers) {
    if (begin.substr(0, container.magic.size()) == container.magic) refuse(container.words);
  }
  if (begin.substr(0, 4) == std::string_view("PK\x03\x04", 4)) {
    const bool is_network = begin.find("data.pkl") != std::string_view::npos;
    refuse(is_network ? "a PyTorch file: a network or tensors, not a log (pinnquad convert)"
           : begin.find(".npy") != std::string_view::npos
               ? "NumPy arrays (a table: pandas.DataFrame(dict(numpy.load(FILE))).to_csv('log.csv'))"
               : "one compressed by zip (restore it with unzip)");
  }
  if (is_telemetry(begin)) {
    refuse(
        "MAVLink telemetry, a .tlog (too slow for a model: take the vehicle's own log; a table: mavlogdump.py --format "
        "csv "
        "--types ATTITUDE FILE)");
  }
}

}  // namespace pinnquad::logs
