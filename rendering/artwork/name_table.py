"""Words in names of layers, and what they mean: See-through's tags, and what artists write."""

from __future__ import annotations

from typing import Literal

__all__ = ["ALTERNATES", "CLOSED", "MOVING", "OPEN", "ORNAMENTS", "PARTS_OF_STATES", "PLACES", "STILL", "Held"]

Held = Literal["top", "covered", "waist", "end", "bottom"]
"""Where a layer is held: at its top, where other layers cover it, at the waist, at the end that touches the body, or at
its bottom."""

MOVING: tuple[tuple[str, str, Held, str], ...] = (
    # Kind, preset, where it is held, and words: Latin ones stand alone in a name, others anywhere. The first that is
    # found counts, so what is narrower stands above what is wider.
    (
        "animal ears",
        "leaf",
        "bottom",
        "animal ears, animal ear, kemonomimi, nekomimi, cat ears, bunny ears, "
        "rabbit ears, ケモ耳, けも耳, ケモミミ, 猫耳, 獣耳, 兽耳, 獸耳, 兔耳",
    ),
    (
        "ribbon",
        "ribbon",
        "end",
        "ribbon, ribbons, bow, bows, streamer, streamers, リボン, 丝带, 絲帶, 飘带, 飄帶, 缎带, 緞帶, 蝴蝶结, 蝴蝶結",
    ),
    (
        "front hair",
        "hair",
        "top",
        "front hair, hair front, hairf, fronthair, hairfront, fringe, bangs, "
        "bang, forelock, 前髪, 前发, 前髮, 刘海, 劉海, 瀏海",
    ),
    (
        "back hair",
        "hair",
        "covered",
        "back hair, hair back, hairb, backhair, hairback, 後ろ髪, 後髪, うしろ髪, 后发, 後髮, 后髮, 后髪",
    ),
    (
        "side hair",
        "hair",
        "top",
        "side hair, hair side, hairs, sidehair, hairside, sidelock, sidelocks, "
        "sideburn, sideburns, 横髪, 横毛, もみあげ, 揉み上げ, 側髮, 侧发, 鬓发, 鬢髮, 鬓角",
    ),
    (
        "ponytail",
        "hair",
        "covered",
        "ponytail, ponytails, pony tail, pigtail, pigtails, twintail, twintails, "
        "twin tail, twin tails, braid, braids, plait, ポニーテール, ツインテール, おさげ, 三つ編み, "
        "みつあみ, 马尾, 馬尾, 辫子, 辮子",
    ),
    (
        "ahoge",
        "hair",
        "bottom",
        "ahoge, アホ毛, あほ毛, 呆毛",
    ),
    (
        "hair",
        "hair",
        "top",
        "hair, lock, locks, strand, strands, tress, tresses, 髪, 毛束, 头发, 頭髮, 发丝, 髮, 长发, 短发",
    ),
    (
        "scarf",
        "ribbon",
        "end",
        "scarf, muffler, shawl, stole, necktie, マフラー, スカーフ, ストール, ネクタイ, 围巾, 圍巾, "
        "领巾, 領巾, 领带, 領帶",
    ),
    (
        "tail",
        "hair",
        "end",
        "tail, tails, しっぽ, シッポ, 尻尾, 尾巴",
    ),
    (
        "cape",
        "cloth",
        "covered",
        "cape, cloak, mantle, マント, ケープ, 披风, 披風, 斗篷",
    ),
    (
        "skirt",
        "cloth",
        "waist",
        "skirt, skirts, bottomwear, hem, スカート, 裙",
    ),
    (
        "sleeve",
        "cloth",
        "end",
        "sleeve, sleeves, 袖",
    ),
    (
        "flag",
        "cloth",
        "end",
        "flag, flags, banner, curtain, curtains, 旗, カーテン, 窗帘, 窗簾",
    ),
    (
        "feather",
        "leaf",
        "end",
        "feather, feathers, 羽毛",
    ),
    (
        "wings",
        "cloth",
        "end",
        "wing, wings, 翼, 羽根, 翅膀",
    ),
    (
        "leaves",
        "leaf",
        "bottom",
        "leaf, leaves, plant, plants, grass, foliage, 葉, 草, 植物, 叶子, 树叶",
    ),
    (
        "tassel",
        "ribbon",
        "top",
        "tassel, tassels, string, strings, cord, cords, タッセル, 紐, ひも, 流苏, 流蘇, 绳子, 繩子",
    ),
)

ORNAMENTS = (
    "hair ornament, hair ornaments, hair accessory, hairpin, hair pin, "
    "hairclip, hair clip, hairband, hair band, hair tie, headband, 髪飾り, 髪留め, "
    "ヘアピン, ヘアバンド, 发饰, 髮飾, 发夹, 髮夾, 发带, 髮帶, 头饰, 頭飾, 草履"
)
"""Words of what stands still although a word of the table above is in its name."""

STILL: tuple[tuple[str, str], ...] = (
    # Kinds that stand still, for the reason that is told.
    (
        "face",
        "face, head, skin, 顔, 頭, 脸, 臉, 面部",
    ),
    (
        "eyes",
        "eye, eyes, eyewhite, irides, iris, pupil, pupils, eyelash, eyelashes, "
        "lash, lashes, eyebrow, eyebrows, brow, brows, 目, 瞳, まつ毛, 睫毛, まつげ, 眉, 眼, "
        "虹彩",
    ),
    (
        "eyewear",
        "eyewear, glasses, メガネ, 眼鏡, 眼镜",
    ),
    (
        "ears",
        "ear, ears, earwear, earring, earrings, 耳, イヤリング, ピアス",
    ),
    (
        "nose",
        "nose, 鼻",
    ),
    (
        "mouth",
        "mouth, lips, lip, teeth, tongue, 口, 唇, 歯, 舌, 嘴",
    ),
    (
        "neck",
        "neck, neckwear, collar, 首, 襟, 脖子",
    ),
    (
        "clothes",
        "topwear, handwear, legwear, footwear, headwear, hat, cap, shirt, dress, body, 帽, 服, 上着, 体, 身體",
    ),
    (
        "limbs",
        "arm, arms, hand, hands, leg, legs, foot, feet, finger, fingers, 腕, 手, 脚, 足, 腿",
    ),
    (
        "background",
        "background, backdrop, bg, sky, paper, 背景, 空",
    ),
    (
        "shadow",
        "shadow, shadows, shade, 影, 阴, 陰",
    ),
)

PLACES: tuple[tuple[str, str, Held], ...] = (
    ("front, 前", "front hair", "top"),
    ("back, rear, behind, 後, 后, 奥, うしろ", "back hair", "covered"),
    ("side, 横, サイド, 侧, 側", "side hair", "top"),
)
"""Words of the place of hair anywhere in a name that says hair."""

CLOSED = "close, closed, shut, blink, wink, smile, half closed"
PARTS_OF_STATES = "eye, eyes, mouth, lips, eyelid, eyelids"
ALTERNATES = "閉じ目, 目閉じ, 閉眼, 閉じ口, 口閉じ, 閉口, 闭眼, 闭嘴, 閉嘴, 笑い目, 笑目, ウインク, まばたき, 眨眼"
OPEN = {
    "eye": "eye, eyes, irides, iris, eyewhite, eyelash, eye open, 目, 瞳, 開き目, 目開き, 白目, 眼, 眼睛, 睁眼",
    "mouth": "mouth, mouth open, lips, 口, 開き口, 口開き, 嘴, 张嘴",
}
