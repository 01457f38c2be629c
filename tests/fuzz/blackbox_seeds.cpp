// SPDX-License-Identifier: MIT
// Writes blackbox and DataFlash logs into a folder, for the fuzzer to begin with: blackbox_seeds DIR
#include <string>

#include "fuzz/seeds.hpp"
#include "programs/logs/ulog_bytes.hpp"

namespace {

using pinnquad_test::Bytes;

/// Every encoding and predictor, GPS and slow frames, events.
std::string blackbox(const std::string& version) {
  std::string log =
      "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:" + version +
      "\nH Field I name:loopIteration,time,a,b,c,d,e,f,g,h,i,j,k,vbatLatest,motor[0],motor[1],gyroADC[0],gyroADC[1],"
      "gyroADC[2],accSmooth[0],accSmooth[1],accSmooth[2]\n"
      "H Field I signed:0,0,1,1,1,1,1,1,1,1,1,1,1,0,0,0,1,1,1,1,1,1\n"
      "H Field I predictor:0,0,0,0,0,0,0,0,0,0,4,8,0,9,11,5,0,0,0,0,0,0\n"
      "H Field I encoding:1,1,0,0,0,0,0,0,0,0,0,0,0,3,1,0,0,0,0,0,0,0\n"
      "H Field P predictor:6,2,1,2,3,1,1,1,1,1,1,1,1,1,3,3,3,3,3,3,3,3\n"
      "H Field P encoding:9,0,7,7,7,8,8,8,8,10,10,10,6,6,6,6,0,0,0,0,0,0\n"
      "H Field G name:time,GPS_coord[0],GPS_coord[1]\nH Field G signed:0,1,1\nH Field G predictor:10,7,7\n"
      "H Field G encoding:1,0,0\nH Field H name:GPS_home[0],GPS_home[1]\nH Field H signed:1,1\n"
      "H Field H predictor:0,0\nH Field H encoding:0,0\nH Field S name:flags\nH Field S signed:0\n"
      "H Field S predictor:0\nH Field S encoding:1\nH Firmware revision:INAV 7.1.0 (x) Y\nH I interval:8\n"
      "H P interval:1/2\nH acc_1G:512\nH gyro_scale:0x3f800000\nH motorOutput:1000,2000\n";
  log += "I" + std::string(1, '\0') + "\x10" + std::string(20, '\2');
  for (int i = 0; i < 3; ++i) {
    log += "P" + std::string("\x02\x1b\x00\x47\x00", 5) + std::string(1, '\x0f') + std::string(10, '\3');
    log += "S\1H\2\4G\1\2\3E\x1e\3\1";
  }
  return log + "E\xff" + "End of log" + std::string(1, '\0');
}

std::string padded(std::string text, std::size_t size) {
  text.resize(size, '\0');
  return text;
}
std::string format(unsigned type, unsigned size, const char* name, const char* letters, const char* names) {
  return Bytes()
      .u8(0xa3)
      .u8(0x95)
      .u8(128)
      .u8(type)
      .u8(size)
      .text(padded(name, 4))
      .text(padded(letters, 16))
      .text(padded(names, 64))
      .str();
}
std::string dataflash() {
  std::string log = format(128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns") +
                    format(3, 44, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds") +
                    format(7, 18, "IMU", "QBgcC", "TimeUS,I,G,c,C") + format(8, 16, "RCOU", "QHHB", "TimeUS,C1,C2,M") +
                    format(2, 31, "PARM", "QNf", "TimeUS,Name,Value") + format(4, 75, "MSG", "QZ", "TimeUS,Message");
  const auto head = [](unsigned type) { return Bytes().u8(0xa3).u8(0x95).u8(type).str(); };
  log += head(3) + Bytes().u64(0).u8(7).text(padded("s#", 16)).zeros(16).str();
  log += head(4) + Bytes().u64(0).text(padded("ArduCopter", 64)).str();
  for (unsigned i = 0; i < 4; ++i) {
    log += head(7) + Bytes().u64(1000 * i).u8(i % 2).u16(i).u16(i).u16(i).str();
    log += head(8) + Bytes().u64(1000 * i).u16(1500).u16(1200).u8(1).str();
  }
  return log + head(2) + Bytes().u64(1).text(padded("SERVO1_FUNCTION", 16)).f32(33).str();
}

}  // namespace

int main(int argument_count, char** arguments) {
  return pinnquad_test::write_seeds(argument_count, arguments,
                                    {blackbox("2"), blackbox("1"), blackbox("2") + blackbox("2"), dataflash()});
}
