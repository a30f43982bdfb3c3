// The cell of the whole sessions, for this test program too.
#include "tests/sessions/cell.cc"  // NOLINT(bugprone-suspicious-include)
