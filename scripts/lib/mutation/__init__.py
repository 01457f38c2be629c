# SPDX-License-Identifier: MIT
"""What scripts/mutation is made of: rules (edits and their draw), tree (a copy, built), tests (what sees a file), judge, survivors."""
