# SPDX-License-Identifier: Apache-2.0
"""Files that Navette keeps for the user between runs, such as compiled kernels."""
