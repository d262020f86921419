#include "tests/service/wrong_messages.hpp"

namespace limn::server::testing {
namespace {

std::string nested(size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

}  // namespace

const std::vector<WrongMessage>& wrongMessages() {
  static const std::vector<WrongMessage> cases{
      {"empty", "", "bad-message", "byte 0"},
      {"notJson", "hello", "bad-message", "byte 0"},
      {"halfAnObject", R"({"op":"ping","seq":2)", "bad-message", "byte 20"},
      {"trailingBytes", R"({"op":"ping","seq":2} x)", "bad-message", "byte 22"},
      {"anArray", R"([1,2,3])", "bad-message", ""},
      {"aNumber", "7", "bad-message", ""},
      {"noOp", R"({"seq":3})", "bad-message", "seq 3 /op"},
      {"opOfWrongType", R"({"op":7,"seq":4})", "bad-message", "seq 4 /op"},
      {"unknownOp", R"({"op":"explode","seq":5})", "unknown-op", "seq 5 /op"},
      {"noSeq", R"({"op":"ping"})", "bad-message", "/seq"},
      {"seqZero", R"({"op":"ping","seq":0})", "out-of-range", "/seq"},
      {"seqNegative", R"({"op":"ping","seq":-1})", "out-of-range", "/seq"},
      {"seqTooLarge", R"({"op":"ping","seq":4294967296})", "out-of-range", "/seq"},
      {"seqNotWhole", R"({"op":"ping","seq":6.5})", "bad-message", "/seq"},
      {"seqDoesNotRise", R"({"op":"ping","seq":1})", "bad-seq", "seq 1"},
      {"unknownField", R"({"op":"ping","seq":10,"extra":1})", "bad-message", "seq 10 /extra"},
      {"fieldTwice", R"({"op":"ping","seq":11,"seq":12})", "bad-message", ""},
      {"missingField", R"({"op":"pick","seq":13,"x":1})", "bad-message", "seq 13 /y"},
      {"wrongType", R"({"op":"pick","seq":14,"x":"1","y":1})", "bad-message", "seq 14 /x"},
      {"outOfRange", R"({"op":"set","seq":15,"target":"material","material":0,"roughness":2})",
       "out-of-range", "seq 15 /roughness"},
      {"notANumber", R"({"op":"set","seq":16,"target":"material","material":0,"roughness":NaN})",
       "bad-message", "byte 66"},
      {"tooLargeForDouble", R"({"op":"set","seq":17,"target":"light","light":0,"intensity":1e999})",
       "out-of-range", "byte 64"},
      {"noTarget", R"({"op":"set","seq":18,"material":0})", "bad-message", "seq 18 /target"},
      {"unknownTarget", R"({"op":"set","seq":19,"target":"cloud"})", "out-of-range", "seq 19 /target"},
      {"indexOutOfRange", R"({"op":"set","seq":20,"target":"material","material":99,"roughness":0.5})",
       "out-of-range", "seq 20 /material"},
      {"shortVector", R"({"op":"camera","seq":21,"eye":[0,0],"target":[0,0,0],"up":[0,1,0]})",
       "bad-message", "seq 21 /eye"},
      {"emptyBatch", R"({"op":"batch","seq":22,"edits":[]})", "out-of-range", "seq 22 /edits"},
      {"wrongEditInBatch",
       R"({"op":"batch","seq":23,"edits":[{"target":"light","light":0},{"target":"light","light":0,"range":-1}]})",
       "out-of-range", "seq 23 /edits/1/range"},
      {"indexOutOfRangeInBatch",
       R"({"op":"batch","seq":24,"edits":[{"target":"resolve"},{"target":"material","material":99}]})",
       "out-of-range", "seq 24 /edits/1/material"},
      {"unknownToneMap", R"({"op":"set","seq":25,"target":"resolve","toneMap":"sepia"})",
       "out-of-range", "seq 25 /toneMap"},
      {"imageTooLarge", R"({"op":"set","seq":26,"target":"image","width":8192,"height":64})", "out-of-range", "seq 26 /width"},
      {"imageTooSmall", R"({"op":"set","seq":27,"target":"image","width":1,"height":64})",
       "out-of-range", "seq 27 /width"},
      {"ackOfNoFrame", R"({"op":"ackFrame","seq":28,"frameId":4000000000,"dropped":false})", "bad-ack", "seq 28"},
      {"unknownLayer", R"({"op":"save","seq":29,"layers":["smell"]})", "unknown-name", "seq 29 /layers"},
      {"secondHello", R"({"op":"hello","seq":30,"version":1,"client":"again"})", "hello-first", "seq 30"},
      {"deepNesting", R"({"op":"batch","seq":31,"edits":)" + nested(64) + "}", "limit", ""},
      {"veryDeepNesting", nested(200000), "limit", ""},
      {"loneSurrogate", R"({"op":"load","seq":32,"uri":"\ud800"})", "bad-message", "byte 35"},
      {"controlCharacter", "{\"op\":\"load\",\"seq\":32,\"uri\":\"a\nb\"}", "bad-message", "byte 30"},
      {"longString", R"({"op":"load","seq":34,"uri":")" + std::string(5000, 'a') + "\"}",
       "out-of-range", "seq 34 /uri"},
      {"absolutePath", R"({"op":"load","seq":35,"uri":"/etc/passwd"})", "path", "/etc/passwd"},
      {"pathOutOfTheRoot", R"({"op":"load","seq":36,"uri":"../../etc/passwd"})", "path", "../../etc/passwd"},
      {"noSuchFile", R"({"op":"load","seq":37,"uri":"no-such-scene.glb"})", "io", "no-such-scene.glb"},
      {"directoryAsFile", R"({"op":"load","seq":38,"uri":"."})", "path", "."},
      {"unknownView", R"({"op":"set","seq":39,"target":"resolve","view":"camera"})", "out-of-range", "seq 39 /view"},
  };
  return cases;
}

}  // namespace limn::server::testing
