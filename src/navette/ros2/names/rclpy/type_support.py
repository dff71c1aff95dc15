"""Is it a message, a service?"""

from navette.runtime.type_support import (
    Msg,
    MsgT,
    NoTypeSupportImportedException,
    SrvEventT,
    SrvRequestT,
    SrvResponseT,
    check_for_type_support,
    check_is_valid_action_type,
    check_is_valid_msg_type,
    check_is_valid_srv_type,
)

__all__ = [
    "Msg",
    "MsgT",
    "NoTypeSupportImportedException",
    "SrvEventT",
    "SrvRequestT",
    "SrvResponseT",
    "check_for_type_support",
    "check_is_valid_action_type",
    "check_is_valid_msg_type",
    "check_is_valid_srv_type",
]
