# SPDX-License-Identifier: Apache-2.0
"""Files: the user's folders, compiled kernels, private runs, untrusted input."""
