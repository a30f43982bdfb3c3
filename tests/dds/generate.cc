// Types' hashes against published ones and those of another program, and what the generator reads
// and refuses.

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

struct KnownHash {
  const char *type, *hash;
};

/// As ROS 2 Jazzy installs them (share/PACKAGE/msg/TYPE.json), and `ros2 topic info --verbose`
/// shows.
constexpr KnownHash kPublished[] = {
    {"builtin_interfaces/Time",
     "RIHS01_b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197"},
    {"diagnostic_msgs/DiagnosticArray",
     "RIHS01_5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e"},
    {"diagnostic_msgs/DiagnosticStatus",
     "RIHS01_b0e3e692ea2d54a8af2f4ef1930e81556a2db55216b771f8a7d2724ed47bf0e4"},
    {"diagnostic_msgs/KeyValue",
     "RIHS01_d68081eaa540288c5440753baecef0c4e16e81a5f78ad68902ded5100413bb42"},
    {"sensor_msgs/JointState",
     "RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e"},
    {"sensor_msgs/Temperature",
     "RIHS01_72514a14126ab9f8a9abec974c78e5610a367b59db5da355ff1fb982d5bad4b8"},
    {"std_msgs/Bool", "RIHS01_feb91e995ff9ebd09c0cb3d2aed18b11077585839fb5db80193b62d74528f6c9"},
    {"std_msgs/Header", "RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01"},
    {"std_msgs/String", "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"},
};

/// SHA-256 of REP-2011's JSON, written by another program than the generator from the same files.
/// One that changes is another type to whoever listens.
constexpr KnownHash kOwn[] = {
    {"selfcal_msgs/Command",
     "RIHS01_9720f2f2c2f6e1634d379632e53882fd176b977fc888b4994e25449174b4fe57"},
    {"selfcal_msgs/CommandReply",
     "RIHS01_a564063ebe6c87e99050f4b9e5cb785908074dee0c9e798f1d5fcfba1f51f005"},
    {"selfcal_msgs/MotionReply",
     "RIHS01_586470fb8580b4cfe23cb9f48542151893586c96bf08da7e1cb274d1c39c830d"},
    {"selfcal_msgs/MotionRequest",
     "RIHS01_65500909cbe0402f0d56ba3a5e393ef1bf43d36dc88baa094165660de52c8ff5"},
    {"selfcal_msgs/PoseReply",
     "RIHS01_f1bef6d1e7f47696334dbcafdca6476c2506e2f8251db7023a48a3324440dc52"},
    {"selfcal_msgs/PoseRequest",
     "RIHS01_2f0476eba67edceb28d9d901fc6eedde63965a03f5bfb54c7ce9cb690b6f1a11"},
    {"selfcal_msgs/Progress",
     "RIHS01_b081723b244f05e54b39e2e034cfcd37f553dd6b12898b8fc8bcf2909559858a"},
    {"selfcal_msgs/Result",
     "RIHS01_231f14166b93f9af23f5feab95981439142a8796cfa8f942f55f607319de59d3"},
    {"selfcal_msgs/StampedBool",
     "RIHS01_a8610f0596a0e20d6f8409fa4ef21f32abb61028122f6e651b7c0bd991db6045"},
    {"selfcal_msgs/Status",
     "RIHS01_4f0eebe61a9a376aed5e05b79d9f84ddf59b6e51ca777043271220e384f61d61"},
};

TEST(TypeHash, IsThePublishedOneOfEveryKnownType) {
  const auto all = shipped();
  for (const auto& [type, hash] : kPublished) EXPECT_EQ(type_hash(all, type), hash) << type;
}

TEST(TypeHash, IsThatOfAnotherProgramForEveryTypeOfOurs) {
  const auto all = shipped();
  for (const auto& [type, hash] : kOwn) EXPECT_EQ(type_hash(all, type), hash) << type;
  EXPECT_EQ(all.size(), std::size(kPublished) + std::size(kOwn)) << "a type without a reference";
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
