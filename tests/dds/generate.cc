// Types' hashes against published ones, and what the generator reads and refuses.

#include <gtest/gtest.h>

#include <selfcal_messages/types.h>

#include "io/dds/generate/interface_text.h"
#include "io/dds/generate/message_file.h"
#include "io/dds/generate/type_hash.h"

namespace selfcal::generate {
namespace {

MessageDefinitions shipped() {
  auto all = read_messages(SELFCAL_SOURCE_DIR "/io/dds/msg");
  EXPECT_TRUE(all) << all.error().what;
  return *std::move(all);
}

TEST(TypeHash, IsThePublishedOneOfEveryKnownType) {
  const auto all = shipped();

  EXPECT_EQ(type_hash(all, "diagnostic_msgs/DiagnosticArray"),
            "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e");
  EXPECT_EQ(type_hash(all, "diagnostic_msgs/DiagnosticStatus"),
            "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4");
  EXPECT_EQ(type_hash(all, "diagnostic_msgs/KeyValue"),
            "RIHS01_d68081eaa540288c5440753baecef0c4e16e81a5f78ad68902ded5100413bb42");
  EXPECT_EQ(type_hash(all, "std_msgs/Bool"),
            "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9");
  EXPECT_EQ(type_hash(all, "std_msgs/Header"),
            "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01");
  EXPECT_EQ(type_hash(all, "std_msgs/String"),
            "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18");
}

TEST(TypeHash, IsWhatTheGeneratedHeaderCarries) {
  const auto all = shipped();

  EXPECT_EQ(dds::message_type<dds::DiagnosticArray>.hash,
            type_hash(all, "diagnostic_msgs/DiagnosticArray"));
  EXPECT_EQ(dds::message_type<dds::Status>.hash, type_hash(all, "selfcal_msgs/Status"));
  EXPECT_EQ(dds::message_type<dds::JointState>.hash, type_hash(all, "sensor_msgs/JointState"));
}

TEST(TypeHash, SeesNamesBoundsAndOrder) {
  const auto hash = [](const std::string& text) {
    return type_hash({{"p/A", *parse_message("p", "A", text)}}, "p/A");
  };
  const std::string plain = hash("int32 a\nint32 b\n");

  EXPECT_EQ(plain, hash("# a comment\nint32 LIMIT=3\n\n  int32   a # other\r\nint32 b"));
  EXPECT_NE(plain, hash("int32 b\nint32 a\n"));
  EXPECT_NE(plain, hash("int32 a\nint32 c\n"));
  EXPECT_NE(plain, hash("int32 a\nuint32 b\n"));
  EXPECT_NE(hash("string[3] a"), hash("string[4] a"));
  EXPECT_NE(hash("string[3] a"), hash("string[<=3] a"));
  EXPECT_NE(hash("string<=3 a"), hash("string a"));
}

TEST(TypeHash, DescribesFieldsByTheNumbersOfTheirTypes) {
  const MessageDefinitions all = {
      {"p/A", *parse_message("p", "A", "float64[] x\nB[2] b\nstring<=8[<=4] s\nchar c")},
      {"p/B", *parse_message("p", "B", "bool on")}};

  EXPECT_EQ(
      type_description(all, "p/A"),
      R"({"type_description": {"type_name": "p/msg/A", "fields": [)"
      R"({"name": "x", "type": {"type_id": 155, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}, )"
      R"({"name": "b", "type": {"type_id": 49, "capacity": 2, "string_capacity": 0, "nested_type_name": "p/msg/B"}}, )"
      R"({"name": "s", "type": {"type_id": 117, "capacity": 4, "string_capacity": 8, "nested_type_name": ""}}, )"
      R"({"name": "c", "type": {"type_id": 3, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}, )"
      R"("referenced_type_descriptions": [{"type_name": "p/msg/B", "fields": [)"
      R"({"name": "on", "type": {"type_id": 15, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}]})");
}

TEST(MessageFile, RefusesWhatRosWouldRefuseAndWhatIsNotReadHere) {
  for (const char* text : {"", "# nothing\n", "int32", "int32 Upper", "int32 a__b", "int32 a_",
                           "int32 _a", "int32 1a", "int32 a\nint32 a", "int32 a 5", "wstring a",
                           "int32<=3 a", "int32[ a", "int32[-1] a", "a/b/C d"})
    EXPECT_FALSE(parse_message("p", "A", text)) << text;
}

TEST(MessageFile, RefusesAMessageOfAMissingOne) {
  EXPECT_FALSE(read_messages(SELFCAL_SOURCE_DIR "/io/dds/msg/diagnostic_msgs"));
  EXPECT_FALSE(read_messages(SELFCAL_SOURCE_DIR "/io/dds/nowhere"));
}

TEST(InterfaceText, NamesTypesAndFieldsAsRosDoes) {
  const auto message =
      parse_message("p", "A", "std_msgs/Header header\nfloat64[] struct\nbyte[3] b");

  EXPECT_EQ(idl_text(*message),
            "#ifndef p__msg__A_IDL\n"
            "#define p__msg__A_IDL\n"
            "#include \"std_msgs/msg/Header.idl\"\n"
            "module p { module msg { module dds_ {\n"
            "struct A_ {\n"
            "  std_msgs::msg::dds_::Header_ header_;\n"
            "  sequence<double> struct_;\n"
            "  octet b_[3];\n"
            "};\n"
            "}; }; };\n"
            "#endif\n");
}

TEST(InterfaceText, RefusesTwoMessagesOfOneName) {
  const auto a = *parse_message("p", "A", "int32 x"), b = *parse_message("q", "A", "int32 x");

  EXPECT_FALSE(header_text({{"p/A", a}, {"q/A", b}}));
}

}  // namespace
}  // namespace selfcal::generate
