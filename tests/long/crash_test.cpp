// Kills two hundred shows.
#include "app/crash.h"

namespace limber::app::test {
namespace {

TEST(LongCrash, RecoversTwoHundredKilledShows) { crash(200, 8); }

}  // namespace
}  // namespace limber::app::test
