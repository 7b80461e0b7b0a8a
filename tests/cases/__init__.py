"""What tests of several tiers share: texts of jobs and scenes, closed-form structures, stand-ins for programs."""
