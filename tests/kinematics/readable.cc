// Figures that a person reads have no powers of ten.
#include "kinematics/readable.h"

#include <gtest/gtest.h>

namespace selfcal {
namespace {

TEST(Readable, WritesFiguresOut) {
  EXPECT_EQ(plain_figure(1810), "1810");
  EXPECT_EQ(plain_figure(1814.6), "1810");
  EXPECT_EQ(plain_figure(0.0000655), "0.0000655");
  EXPECT_EQ(plain_figure(-0.02), "-0.02");
  EXPECT_EQ(plain_figure(9.996), "10");
  EXPECT_EQ(plain_figure(99.96), "100");
  EXPECT_EQ(plain_figure(0), "0");
  EXPECT_EQ(plain_figure(12.345, 4), "12.35");
  EXPECT_EQ(plain_figure(1e-9), "1e-09");
  EXPECT_EQ(with_figures("%.3g mm, p = %.2g", 1814.6, 3e-15), "1810 mm, p = 3e-15");
  EXPECT_EQ(with_figures("-%.2g and %.3g", 4.7e2, 1e12), "-470 and 1e+12");
}

TEST(Readable, GivesUnitsThatAPersonReads) {
  EXPECT_EQ(in_readable_unit(-6.55e-5, "rad"), "-0.0655 mrad");
  EXPECT_EQ(in_readable_unit(1.1e-5, "m"), "0.011 mm");
  EXPECT_EQ(in_readable_unit(7.8e-5, "1"), "78 ppm");
  EXPECT_EQ(in_readable_unit(4.1e-6, "rad/(N m)"), "4.1 urad/(N m)");
  EXPECT_EQ(in_readable_unit(2.5e-9, "m/N"), "2.5 nm/N");
  EXPECT_EQ(in_readable_unit(-1.2e-5, "1/K"), "-12 ppm/K");
  EXPECT_EQ(in_readable_unit(20, "s"), "20 s");
}

TEST(Readable, ListsNamesAsAPersonWould) {
  EXPECT_EQ(listed({}), "");
  EXPECT_EQ(listed({"j1"}), "j1");
  EXPECT_EQ(listed({"j1", "j2"}), "j1 and j2");
  EXPECT_EQ(listed({"j1", "j2", "j3"}), "j1, j2 and j3");
}

TEST(Readable, HidesWhatATerminalWouldObey) {
  for (const std::string_view text : {"\x1b[31m", "a\nb", "\r", "\x7f",
                                      "\xC2\x9B"
                                      "31m"})
    EXPECT_TRUE(has_control(text)) << text;
  for (const std::string_view text : {"", "wall 2", "Stäubli RX-90", "°C", "日本"}) {
    EXPECT_FALSE(has_control(text)) << text;
    EXPECT_EQ(shown(text), text);
  }
  EXPECT_EQ(shown("a\x1b[31mb\nc\xC2\x9B"
                  "d"),
            "a?[31mb\nc?d");
}

TEST(Readable, LeavesOutTheMiddleOfWhatNobodyReads) {
  std::string text = "row 2: no set is called '";
  for (int i = 0; i < 5000; ++i) text += "ä";
  text += "'; known: table";
  const std::string told = shown(text);
  EXPECT_LT(told.size(), 1400U);
  EXPECT_TRUE(told.starts_with("row 2: no set is called 'ää"));
  EXPECT_TRUE(told.ends_with("ä'; known: table"));
  EXPECT_NE(told.find("ä … (8740 bytes left out) … ä"), std::string::npos) << told;
  EXPECT_LT(shown("x" + std::string(4000, '\x80')).size(), 1400U);  // no text at all
  const std::string whole(2000, 'x');
  EXPECT_EQ(shown(whole), whole);
}

}  // namespace
}  // namespace selfcal
